// Whether the stage can go somewhere, and why not: asked of the controller, one question at a time, the latest place first.

import { fields, plain, shown } from "./gcs.js";

export class Reach {
  #busy = false;
  #next = null;

  constructor(stage, frames) {
    Object.assign(this, { stage, frames });
  }

  /** Asks about a place, mm; `tell({ place, good, reason })` is called unless another place was asked about meanwhile. */
  check(place, tell) {
    this.#next = { place, tell };
    if (!this.#busy) this.#run();
  }

  async #run() {
    this.#busy = true;
    while (this.#next) {
      const { place, tell } = this.#next;
      this.#next = null;
      const verdict = await this.verdict(place);
      if (!this.#next) tell({ place, ...verdict });
    }
    this.#busy = false;
  }

  /** { good, reason } of a place, asked at once. */
  verdict(place) {
    return this.#ask(place).catch((error) => ({ good: false, reason: error.message }));
  }

  async #ask([x, y]) {
    const { link, referenced, servo, mode } = this.stage;
    const good = (await link.ask(`VMO? X ${plain(x)} Y ${plain(y)}`)) === "1";
    if (!good) return { good, reason: await this.#why(x, y) };
    if (mode === "fault" || mode === "stopping") return { good: false, reason: "a fault is latched: acknowledge it first" };
    if (!referenced) return { good: false, reason: "reachable, but the stage is not referenced yet" };
    if (!servo) return { good: false, reason: "reachable, but the servo is off" };
    return { good, reason: "" };
  }

  /** In words, from the limits that the controller tells. */
  async #why(x, y) {
    const { link, geometry, target } = this.stage;
    const limits = {};
    for (const question of ["NLM?", "PLM?", "SSL?"]) limits[question] = fields(await link.ask(`${question} X Y`));
    for (const [axis, value] of [["X", x], ["Y", y]]) {
      if (limits["SSL?"][axis] !== "1") continue;
      const [least, most] = [Number(limits["NLM?"][axis]), Number(limits["PLM?"][axis])];
      if (value < least || value > most) {
        return `beyond the soft limits of ${axis.toLowerCase()}: ${shown(least, 1)} to ${shown(most, 1)} mm`;
      }
    }
    const distance = Math.hypot(x, y);
    if (this.frames.plain && distance > geometry.disk) {
      return `outside the usable disk: ${shown(distance, 1)} mm from the centre, ${shown(geometry.disk, 1)} mm is the limit at every orientation`;
    }
    if (!this.frames.plain) return "with this frame and centre of rotation the platform would leave the usable disk, there or on the way";
    return `the way there from ${target.slice(0, 2).map((v) => shown(v, 1)).join(", ")} is refused: the platform would leave the usable disk`;
  }
}
