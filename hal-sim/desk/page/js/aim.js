// Pointing at the stage: whether it can go there is shown before the click; the click has it go.

import { byId, report, setText } from "./dom.js";
import { plain, shown } from "./gcs.js";
import { Reach } from "./reach.js";

const KEYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const HINT = "Point at the disk to see whether the stage can go there; click, and it goes.";

export class Aim {
  /** { place: [mm, mm], good, reason }, or null: nobody aims. `good` is undefined until the controller has answered. */
  at = null;

  constructor(stage, scene) {
    Object.assign(this, { stage, scene, reach: new Reach(stage, scene.frames), output: byId("aim"), go: byId("aim-go") });
    const { canvas } = scene;
    canvas.addEventListener("pointermove", (event) => { if (event.pointerType !== "touch") this.#point(this.#placeOf(event)); });
    canvas.addEventListener("pointerleave", (event) => { if (event.pointerType !== "touch") this.#leave(); });
    canvas.addEventListener("click", (event) => {
      const place = this.#placeOf(event);
      if (event.pointerType === "touch") this.#aim(place);
      else this.#goTo(place);
    });
    canvas.addEventListener("keydown", (event) => this.#key(event));
    this.go.addEventListener("click", () => this.#move(this.at.place));
    stage.addEventListener("link", () => this.#leave());
  }

  /** A pointer passes over many places: nobody is to hear of each. */
  #point(place) {
    this.output.setAttribute("aria-live", "off");
    this.#aim(place);
  }

  #placeOf(event) {
    return this.scene.targetAt(event.offsetX, event.offsetY).map((mm) => Math.round(mm * 10) / 10);
  }

  /** Shows what the controller says of a place. */
  #aim(place) {
    this.at = { place };
    this.reach.check(place, (verdict) => {
      this.at = verdict;
      this.#show();
    });
  }

  /** The same, and goes there if it can, wherever is pointed at meanwhile. */
  async #goTo(place) {
    this.at = { place };
    const verdict = await this.reach.verdict(place);
    if (this.at?.place === place) {
      this.at = { place, ...verdict };
      this.#show();
    }
    if (verdict.good) this.#move(place);
  }

  #show() {
    const { place: [x, y], good, reason } = this.at;
    this.output.className = good ? "good" : "bad";
    setText(this.output, `x ${shown(x, 1)}, y ${shown(y, 1)} mm: ${good ? "reachable" : reason}`);
    this.go.hidden = !good || matchMedia("(hover: hover)").matches;
  }

  #leave() {
    this.at = null;
    this.output.className = "";
    this.go.hidden = true;
    setText(this.output, HINT);
  }

  #key(event) {
    const { key, shiftKey } = event;
    if (key === "Enter" && this.at) this.#goTo(this.at.place);
    if (!KEYS[key]) return;
    event.preventDefault();
    this.output.setAttribute("aria-live", "polite");
    const from = this.at?.place ?? this.stage.measured?.slice(0, 2) ?? [0, 0];
    this.#aim(from.map((mm, i) => Math.round(mm + KEYS[key][i] * (shiftKey ? 10 : 1))));
  }

  #move([x, y]) {
    report(byId("said"), () => this.stage.link.ask(`MOV X ${plain(x)} Y ${plain(y)}`), "on its way");
  }
}
