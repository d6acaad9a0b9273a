// Reference, servo, target, home, speed and halt.

import { byId, report, setText } from "./dom.js";
import { fields, plain, shown, typed } from "./gcs.js";

const AXES = { x: "X", y: "Y", w: "W" };
const NAMES = { x: "x", y: "y", w: "θ" };
/** Decimals of a target in an empty field. */
const DECIMALS = 4;

export function drive(stage) {
  const { link } = stage;
  const said = byId("said");
  const say = (action, done) => report(said, action, done);

  byId("halt").addEventListener("click", () => say(async () => {
    // Halting reports error 10 as it is meant to.
    await link.ask("HLT").catch((error) => { if (error.number !== 10) throw error; });
  }, "halt sent"));
  for (const id of ["reference", "reference-again"]) byId(id).addEventListener("click", () => say(() => link.ask("FRF"), "referenced"));
  servoSwitch(stage, say);
  moveForm(stage, say);
  speed(stage, say);
}

/** The servo as a switch that says what pressing it does. */
function servoSwitch(stage, say) {
  const [servo, state, does] = ["servo", "servo-state", "servo-does"].map(byId);
  servo.addEventListener("click", () => {
    const wanted = stage.servo ? 0 : 1;
    say(() => stage.link.ask(`SVO X ${wanted}`), `servo ${wanted ? "on" : "off"}`);
  });
  stage.addEventListener("slow", () => {
    const { servo: on, referenced } = stage;
    servo.setAttribute("aria-checked", String(on));
    servo.disabled = !referenced;
    setText(state, on ? "Servo on" : "Servo off");
    const off = referenced ? "Switching on: the motors hold the stage where it is." : "Referencing switches it on.";
    setText(does, on ? "Switching off: the motors let go, and the stage can be pushed." : off);
  });
}

/** Targets by number: empty fields stand for the present target, and are not sent. */
function moveForm(stage, say) {
  const ids = Object.keys(AXES);
  byId("target").addEventListener("submit", async (event) => {
    event.preventDefault();
    const moves = await say(() => {
      const filled = ids.filter((id) => byId(id).value.trim() !== "");
      if (!filled.length) throw new Error("nothing to do: no field is filled in");
      return stage.link.ask(`MOV ${filled.map((id) => `${AXES[id]} ${plain(number(id, NAMES[id]))}`).join(" ")}`);
    }, "on its way");
    if (!moves) return;
    for (const id of ids) byId(id).value = "";
  });
  byId("home").addEventListener("click", () => say(() => stage.link.ask("MOV X 0 Y 0 W 0"), "on its way"));
  stage.addEventListener("slow", () => {
    ids.forEach((id, i) => {
      const text = stage.referenced ? shown(stage.target[i], DECIMALS) : "";
      if (byId(id).placeholder !== text) byId(id).placeholder = text;
    });
    setText(byId("home-way"), stage.referenced ? wayHome(stage) : "");
  });
}

/** How far it is to 0, 0, 0 in words. */
function wayHome({ target: [x, y, deg], turning }) {
  const distance = Math.hypot(x, y);
  const turn = turnTo(0, deg, turning);
  const way = distance < 1e-3 ? "" : `${shown(distance, distance < 1 ? 3 : 1)} mm`;
  const turns = Math.abs(turn) >= 360 ? ` (${shown(Math.abs(turn) / 360, 2)} turns)` : "";
  const rotation = Math.abs(turn) < 1e-3 ? "" : `${shown(Math.abs(turn), 1)}° ${turn > 0 ? "counterclockwise" : "clockwise"}${turns}`;
  return [way, rotation].filter(Boolean).join(", and ") || "it is there";
}

/** By how much theta turns on its way, deg. */
function turnTo(to, from, turning) {
  const literal = to - from;
  const positive = ((literal % 360) + 360) % 360;
  if (turning === 1) return positive > 180 ? positive - 360 : positive;
  if (turning === 2) return positive;
  if (turning === 3) return positive && positive - 360;
  return literal;
}

/** Commands that move to a target. */
const TO_TARGET = /^(MOV|MVR|MRT|MRW)\b/;
/** Commands that move otherwise, or stop: a target sent after them would be another motion. */
const OTHERWISE = /^(JOG|WGO|MAC|STP|HLT|STE|SVO|FRF|RBT)\b/;

/** The speed as a number, and as a share of the fastest. A move to a target that was begun here goes on with it at once. */
function speed(stage, say) {
  const { link } = stage;
  const [field, override, share] = ["vls", "override", "override-share"].map(byId);
  let own = false;
  link.addEventListener("asked", ({ detail: line }) => {
    if (TO_TARGET.test(line)) own = true;
    else if (OTHERWISE.test(line)) own = false;
  });
  link.addEventListener("stopping", () => { own = false; });
  const set = (mmS) => say(async () => {
    await link.ask(`VLS ${plain(mmS)}`);
    if (!own || stage.mode !== "moving") return;
    const { X, Y, W } = fields(await link.ask("MOV? X Y W"));
    if (own) await link.ask(`MOV X ${X} Y ${Y} W ${W}`);
  }, `speed set: ${shown(mmS, 1)} mm/s`);
  byId("speed").addEventListener("submit", (event) => {
    event.preventDefault();
    say(() => link.ask(`VLS ${plain(number("vls", "speed"))}`), "speed set").then((good) => { if (good) field.value = ""; });
  });
  const showShare = () => setText(share, `${override.value} %`);
  override.addEventListener("input", showShare);
  override.addEventListener("change", () => set(stage.fastest * Number(override.value) / 100));
  stage.addEventListener("slow", () => {
    const text = String(stage.velocity);
    if (field.placeholder !== text) field.placeholder = text;
    if (document.activeElement === override) return;
    const percent = String(Math.max(1, Math.round(100 * stage.velocity / stage.fastest)));
    if (override.value !== percent && Number.isFinite(stage.fastest)) override.value = percent;
    showShare();
  });
}

/** The number in a field; throws with its name, and marks it, when there is none. */
export function number(id, name) {
  const field = byId(id);
  const value = typed(field.value);
  const good = Number.isFinite(value);
  field.setAttribute("aria-invalid", String(!good));
  if (!good) throw new Error(`${name}: “${field.value}” is not a number`);
  return value;
}
