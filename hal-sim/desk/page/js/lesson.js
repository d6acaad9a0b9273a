// How three pivots make x, y and theta, shown by movements that the server computed with the stage's own kinematics.

import { byId, make, setText } from "./dom.js";
import { drawMechanism, drawTrack } from "./mechanism.js";
import { onColours } from "./theme.js";
import { fit, inSight, Plane } from "./view.js";

/** Longest wait for the movements. */
const PATIENCE_MS = 2000;
const SECONDS = 5;
/** Rounds after which it rests, until it is chosen anew. */
const ROUNDS = 3;
const GEOMETRY = { radius: 100, start: 20, end: 180, disk: 80 };

/** The mechanism at an instant of a movement. */
export function drawFrame(canvas, { pose: [x, y, deg], pivots }) {
  const { context, width, height } = fit(canvas);
  const plane = new Plane(width, height, 1.75 * GEOMETRY.radius);
  context.clearRect(0, 0, width, height);
  drawTrack(context, plane, GEOMETRY);
  drawMechanism(context, plane, GEOMETRY, { centre: [x, y], deg, pivots });
}

export class Lesson {
  #movements = [];
  #chosen = 0;
  #begun = 0;
  #drawn = "";

  constructor() {
    this.canvas = byId("lesson-scene");
    this.still = matchMedia("(prefers-reduced-motion: reduce)");
    onColours(() => { this.#drawn = ""; });
    byId("lesson").addEventListener("toggle", () => { this.#begun = performance.now(); });
    this.#load();
  }

  async #load() {
    const response = await fetch("/lesson.json", { signal: AbortSignal.timeout(PATIENCE_MS) });
    this.#movements = await response.json();
    const choice = byId("lesson-choice");
    this.buttons = this.#movements.map(({ name }, index) => {
      const button = make("button", { type: "button", textContent: name, "aria-pressed": "false" });
      button.addEventListener("click", () => this.#choose(index));
      return button;
    });
    choice.append(...this.buttons);
    this.#choose(0);
  }

  #choose(index) {
    this.#chosen = index;
    this.#begun = performance.now();
    this.buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(i === index)));
    setText(byId("lesson-caption"), this.#movements[index].caption);
  }

  draw() {
    const movement = this.#movements[this.#chosen];
    if (!movement || !inSight(this.canvas)) return;
    const share = this.still.matches ? 0.25 : Math.min((performance.now() - this.#begun) / 1000 / SECONDS, ROUNDS) % 1;
    const frame = Math.floor(share * movement.frames.length);
    const key = `${this.#chosen} ${frame} ${this.canvas.clientWidth} ${devicePixelRatio}`;
    if (key === this.#drawn) return;
    this.#drawn = key;
    drawFrame(this.canvas, movement.frames[frame]);
  }
}
