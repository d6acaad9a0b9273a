// Frames of the user's own and the centre of rotation: where they lie, which are in force, and defining them.

import { byId, make, report } from "./dom.js";
import { fields, plain, typed } from "./gcs.js";

const DEG = Math.PI / 180;
const HOME = { x: 0, y: 0, deg: 0 };
/** Kinds of frames that coordinates are told in; a tool frame is in the platform. */
const GROUNDS = ["KSW", "KSD", "KSF"];

/** Where a point of a frame lies in the base frame. */
export function toBase({ x, y, deg }, [px, py]) {
  const [c, s] = [Math.cos(deg * DEG), Math.sin(deg * DEG)];
  return [x + c * px - s * py, y + s * px + c * py];
}

/** Where a point of the base frame lies in a frame. */
export function fromBase({ x, y, deg }, [px, py]) {
  const [c, s] = [Math.cos(deg * DEG), Math.sin(deg * DEG)];
  return [c * (px - x) + s * (py - y), -s * (px - x) + c * (py - y)];
}

/** The frame in which the controller tells and takes coordinates. */
export class Frames {
  /** Where it lies in the base frame, mm and deg. */
  ground = HOME;
  /** Whether it is the base frame, with the platform's centre as the centre of rotation. */
  plain = true;
  /** Whether another point than the platform's centre is moved, and turned about. */
  moved = false;
  /** Whether that point is the origin of a tool frame. */
  tool = false;
  #known = "";

  constructor(stage) {
    this.stage = stage;
    stage.addEventListener("slow", () => this.#look());
    stage.addEventListener("link", () => { this.#known = ""; });
  }

  async #look() {
    const { link, replies } = this.stage;
    const [enabled, centre] = [replies["KEN?"], replies["SPI?"]];
    if (enabled === undefined || `${enabled}\n${centre}` === this.#known) return;
    this.#known = `${enabled}\n${centre}`;
    try {
      const kinds = fields(enabled);
      const name = Object.keys(kinds).find((one) => GROUNDS.includes(kinds[one]));
      const ground = name && name !== "ZERO" ? await placeOfFrame(link, name) : HOME;
      const { R = "0", S = "0" } = fields(centre);
      // With a tool frame its origin is the centre of rotation.
      const tool = Object.values(kinds).includes("KST");
      const [x, y] = toBase(ground, tool ? [0, 0] : [Number(R), Number(S)]);
      this.ground = { x, y, deg: ground.deg };
      this.tool = tool;
      this.moved = tool || Number(R) !== 0 || Number(S) !== 0;
      this.plain = ground === HOME && !this.moved;
      this.stage.dispatchEvent(new Event("frames"));
    } catch {
      this.#known = "";
    }
  }
}

/** Where the chain of a frame lies in the base frame. */
async function placeOfFrame(link, name) {
  const place = fields(await link.ask(`KLT? ${name}`));
  const of = (axis) => Number(place[`${name} ${axis}`]);
  return { x: of("X"), y: of("Y"), deg: of("W") };
}

/** The panel. */
export function framePanel(stage) {
  const [box, body] = [byId("frames"), byId("frames-body")];
  const { link } = stage;
  const said = make("p", { className: "said", role: "status" });
  const list = make("div", { className: "scroll" });
  const field = (label, value = "0") => {
    const input = make("input", { value, autocomplete: "off", "aria-label": label });
    return { input, label: make("label", {}, `${label} `, input) };
  };
  const value = ({ input }, name) => {
    const number = typed(input.value);
    if (!Number.isFinite(number)) throw new Error(`${name}: “${input.value}” is not a number`);
    return plain(number);
  };
  const [r, s] = [field("R"), field("S")];
  const set = make("button", { type: "submit", textContent: "Set" });
  const centre = make("form", { className: "row" }, make("b", { textContent: "Centre of rotation, mm from the platform’s centre:" }), r.label, s.label, set);
  const [name, x, y, w] = [field("name", "SAMPLE"), field("x"), field("y"), field("θ")];
  const kinds = [["KSW", "Work frame"], ["KST", "Tool frame"]].map(([word, text]) => {
    const button = make("button", { type: "button", textContent: text, className: "quiet" });
    button.addEventListener("click", () => act(() => `${word} ${name.input.value} X ${value(x, "x")} Y ${value(y, "y")} W ${value(w, "θ")}`, "defined"));
    return button;
  });
  const here = make("button", { type: "button", textContent: "Here", className: "quiet", title: "A work frame where the platform is now" });
  here.addEventListener("click", () => act(() => `KSF ${name.input.value}`, "defined here"));
  const define = make("div", { className: "row" }, make("b", { textContent: "Define:" }), name.label, x.label, y.label, w.label, ...kinds, here);
  const act = async (line, done) => {
    await report(said, () => link.ask(line()), done);
    show();
  };
  centre.addEventListener("submit", (event) => {
    event.preventDefault();
    act(() => `SPI R ${value(r, "R")} S ${value(s, "S")}`, "centre of rotation set");
  });
  const show = async () => {
    if (!box.open) return;
    const enabled = fields(await link.ask("KEN?"));
    const names = Object.keys(fields(await link.ask("KLN?")));
    const rows = await Promise.all(names.map(async (one) => {
      const at = await placeOfFrame(link, one);
      const button = make("button", { type: "button", className: "quiet", textContent: one in enabled ? "in force" : "enable", disabled: one in enabled });
      button.addEventListener("click", () => act(() => `KEN ${one}`, `${one} is in force`));
      return make("tr", {}, make("th", { scope: "row", textContent: one }), ...[at.x, at.y, at.deg].map((v) => make("td", { textContent: String(v) })), make("td", {}, button));
    }));
    const head = make("tr", {}, ...["frame", "x mm", "y mm", "θ °", ""].map((text) => make("th", { scope: "col", textContent: text })));
    list.replaceChildren(make("table", { className: "list" }, head, ...rows));
  };
  body.append(make("p", { className: "small", textContent: "Positions are told and taken in the frame in force; ZERO is the stage’s own. The drawing shows it, and the centre of rotation with it." }), list, define, centre, said);
  box.addEventListener("toggle", show);
  stage.addEventListener("link", () => { box.hidden = !["KEN", "KSW", "SPI"].every((word) => stage.knows(word)); });
}
