// Calibration from this page: where to measure, how far it is, what the fit leaves, and what fresh poses say of it.

import { byId, make, setText } from "./dom.js";
import { Orders } from "./orders.js";
import { StepList, fileLink } from "./steps.js";

/** Instruments, and how well they usually measure a length, nm. */
const KITS = {
  xyt: ["x, y and theta: beams, a measuring machine", 50],
  xy: ["x and y of one target", 50],
  theta: ["theta alone", 50],
  camera: ["a camera over a plate", 50],
  camera2: ["a camera at two places", 50],
  balls: ["gauges against balls", 500],
  ends: ["none: the guides’ ends are touched", 2000],
};
/** Orders with which the stage moves. */
const MOVING = ["measure", "resume", "verify"];

/** A number of a field, or what is wrong with it. */
function number(field, name) {
  const value = Number(field.value);
  if (!field.value.trim() || !Number.isFinite(value)) throw new Error(`${name}: ${field.value || "nothing"} is no number`);
  return value;
}

/** A time that is left, in words. */
function left(seconds) {
  return seconds < 90 ? `some ${Math.ceil(seconds / 5) * 5} s left` : `some ${Math.ceil(seconds / 60)} min left`;
}

export class Calibration {
  #isPaused = false;
  #steps = new StepList(byId("calibrate-steps"));
  /** When the first of these visits was told, and which that was. */
  #begun = null;

  constructor(operator, firstMove) {
    for (const name of ["kit", "noise", "turn", "poses", "fresh", "reads", "plan", "measure", "pause", "resume", "end", "apply", "verify", "undo", "bar", "far", "ask", "where", "fields", "reading", "read", "wrong", "said", "files"]) {
      this[name] = byId(`calibrate-${name}`);
    }
    this.orders = new Orders("calibration", operator, firstMove, this.said);
    this.kit.addEventListener("change", () => { this.noise.value = KITS[this.kit.value]?.[1] ?? 50; });
    for (const order of ["plan", "measure"]) this[order].addEventListener("click", () => this.#give(order, () => this.#wish(this.poses)));
    this.verify.addEventListener("click", () => this.#give("verify", () => this.#wish(this.fresh)));
    for (const order of ["resume", "apply", "undo", "end"]) this[order].addEventListener("click", () => this.#give(order));
    this.pause.addEventListener("click", () => this.#give(this.#isPaused ? "continue" : "pause"));
    this.ask.addEventListener("submit", (event) => {
      event.preventDefault();
      const text = this.reading.value;
      this.reading.value = "";
      this.#give("read", () => text);
    });
    operator.addEventListener("calibration", ({ detail }) => this.#show(detail));
  }

  /** What the page asks for, with as many poses as this field says. */
  #wish(poses) {
    return {
      kit: this.kit.value,
      noise_nm: number(this.noise, "noise of a length"),
      noise_urad: this.turn.value.trim() ? number(this.turn, "noise of theta") : null,
      poses: Math.round(number(poses, "poses")),
    };
  }

  #give(order, wish = null) {
    this.orders.give(() => (wish ? { [order]: wish() } : order), MOVING.includes(order));
  }

  #show(status) {
    this.#isPaused = status.is_paused;
    const { kits, reads, runs, is_paused: isPaused, may_resume: mayResume, may_apply: mayApply } = status;
    if (this.kit.childElementCount !== kits.length) {
      this.kit.replaceChildren(...kits.map((kit) => make("option", { value: kit, textContent: `${kit} – ${KITS[kit]?.[0] ?? ""}` })));
    }
    setText(this.reads, reads ?? "you: type what it reads");
    for (const name of ["plan", "measure", "undo"]) this[name].disabled = runs;
    this.resume.disabled = runs || !mayResume;
    for (const name of ["apply", "verify"]) this[name].disabled = runs || !mayApply;
    this.end.disabled = !runs;
    this.pause.disabled = !runs;
    setText(this.pause, isPaused ? "Continue" : "Pause");
    this.#far(status);
    this.#ask(status.asks);
    this.orders.say(status);
    this.#steps.show(status.steps);
    this.#files(status);
  }

  /** How far it is, and how long it will take. */
  #far({ progress, is_paused: isPaused }) {
    this.bar.parentElement.hidden = !progress;
    if (!progress) {
      this.#begun = null;
      return;
    }
    const { made, of } = progress;
    this.#begun ??= { at: performance.now(), made };
    const [seconds, since] = [(performance.now() - this.#begun.at) / 1000, made - this.#begun.made];
    Object.assign(this.bar, { max: of, value: made });
    const rest = since > 2 && made < of ? `, ${left((seconds / since) * (of - made))}` : "";
    setText(this.far, `${made} of ${of} visits${isPaused ? ", paused at the next" : rest}`);
  }

  #ask(asks) {
    const isNew = asks && this.ask.hidden;
    this.ask.hidden = !asks;
    if (!asks) return;
    if (isNew) this.reading.focus();
    setText(this.where, `Visit ${asks.visit}: the stage is at ${asks.where_to}. What does the instrument read?`);
    setText(this.fields, asks.fields);
    setText(this.wrong, asks.wrong);
  }

  #files({ report: page, files }) {
    const all = [...(page ? [[page, "the report", false], [page, "save it", true]] : []), ...files.map((path) => [path, path.split("/").at(-1), true])];
    if (all.length !== this.files.childElementCount) this.files.replaceChildren(...all.map(([path, text, isSaved]) => fileLink(path, text, isSaved)));
  }
}
