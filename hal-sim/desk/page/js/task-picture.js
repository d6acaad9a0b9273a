// What commissioning asks a person to do, drawn with the stage's own kinematics, which the server has computed.

import { drawFrame } from "./lesson.js";
import { onColours } from "./theme.js";
import { inSight } from "./view.js";

/** Longest wait for the movements. */
const PATIENCE_MS = 2000;
const SECONDS = 5;

export class TaskPicture {
  /** `turn` or `jig`; for another, or none, there is no picture. */
  task = "";
  #tasks = {};
  #drawn = "";

  constructor(canvas) {
    this.canvas = canvas;
    this.still = matchMedia("(prefers-reduced-motion: reduce)");
    onColours(() => { this.#drawn = ""; });
    this.#load();
  }

  async #load() {
    const response = await fetch("/tasks.json", { signal: AbortSignal.timeout(PATIENCE_MS) });
    this.#tasks = await response.json();
  }

  draw() {
    const frames = this.#tasks[this.task];
    this.canvas.style.visibility = frames ? "visible" : "hidden";
    if (!frames || !inSight(this.canvas)) return;
    const share = this.still.matches ? 0.99 : (performance.now() / 1000 / SECONDS) % 1;
    const frame = Math.floor(share * frames.length);
    const key = `${this.task} ${frame} ${this.canvas.clientWidth} ${devicePixelRatio}`;
    if (key === this.#drawn) return;
    this.#drawn = key;
    drawFrame(this.canvas, frames[frame]);
  }
}
