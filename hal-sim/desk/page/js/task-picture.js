// What commissioning asks a person to do, drawn with the stage's own kinematics, which the server has computed.

import { drawMechanism, drawTrack } from "./mechanism.js";
import { onColours } from "./theme.js";
import { fit, inSight, Plane } from "./view.js";

/** Longest wait for the movements. */
const PATIENCE_MS = 2000;
const SECONDS = 5;
const GEOMETRY = { radius: 100, start: 20, end: 180, disk: 80 };

export class TaskPicture {
  /** `turn` or `jig`; empty: nothing is drawn. */
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
    if (!frames || !inSight(this.canvas)) return;
    const share = this.still.matches ? 0.99 : (performance.now() / 1000 / SECONDS) % 1;
    const frame = Math.floor(share * frames.length);
    const key = `${this.task} ${frame} ${this.canvas.clientWidth} ${devicePixelRatio}`;
    if (key === this.#drawn) return;
    this.#drawn = key;
    const { context, width, height } = fit(this.canvas);
    const plane = new Plane(width, height, 1.75 * GEOMETRY.radius);
    context.clearRect(0, 0, width, height);
    drawTrack(context, plane, GEOMETRY);
    const { pose: [x, y, deg], pivots } = frames[frame];
    drawMechanism(context, plane, GEOMETRY, { centre: [x, y], deg, pivots });
  }
}
