// Following error and duty while the stage moves, scrolling; paused, they can be zoomed.

import { byId } from "./dom.js";
import { Envelope } from "./envelope.js";
import { Plot } from "./plot.js";
import { remember, remembered } from "./remembered.js";
import { onColours } from "./theme.js";
import { inSight } from "./view.js";
import { control, TimeView } from "./zoom.js";

const KEPT_S = 120;
/** So long after the stage has come to rest the plots stand still, s. */
const REST_S = 2;

export class Scope {
  #restedSince = null;
  #rested = false;
  #drawn = "";

  constructor(stage) {
    this.stage = stage;
    const span = byId("span");
    span.value = remembered("span", span.value);
    span.addEventListener("change", () => remember("span", span.value));
    onColours(() => { this.#drawn = ""; });
    this.data = new Envelope(6, KEPT_S);
    this.view = new TimeView(0, 1);
    const pivots = (first) => [1, 2, 3].map((number) => ({ name: `pivot ${number}`, short: String(number), paint: `pivot-${number}`, channel: first + number - 1 }));
    this.plots = [
      new Plot(byId("error-plot"), { title: "Following error, µrad", series: pivots(0), data: this.data, decimals: 2, symmetric: true }),
      new Plot(byId("duty-plot"), { title: "Duty, %", series: pivots(3), data: this.data, decimals: 1, symmetric: true }),
    ];
    for (const plot of this.plots) control(plot.canvas, this.view, (x) => plot.timeAt(x, this.view.range));
    stage.addEventListener("tick", () => this.#take(stage.now));
    stage.addEventListener("link", () => this.data.gap());
    stage.link.addEventListener("lost", () => this.data.gap());
    const pause = byId("pause");
    pause.addEventListener("click", () => {
      this.view.frozen = !this.view.frozen;
      pause.setAttribute("aria-pressed", String(this.view.frozen));
      pause.textContent = this.view.frozen ? "Go on" : "Pause";
    });
    // Whoever zooms wants to look: nothing runs away meanwhile.
    for (const { canvas } of this.plots) {
      canvas.addEventListener("wheel", () => { if (!this.view.frozen) pause.click(); }, { capture: true });
      canvas.addEventListener("pointerdown", () => { if (!this.view.frozen) pause.click(); }, { capture: true });
    }
  }

  #take({ time, errors, duties }) {
    if (this.view.frozen || this.#rests(time)) return;
    const percent = duties.map((range) => range.map((value) => 100 * value));
    const all = [...errors, ...percent];
    this.data.add(time, all.map(([low]) => low), all.map(([, high]) => high));
  }

  /** Whether the stage has been at rest for a while: there is nothing to see then. */
  #rests(time) {
    const { resting, mode } = this.stage;
    if (!resting || mode === "moving") this.#restedSince = null;
    else this.#restedSince ??= time;
    const rests = this.#restedSince !== null && time - this.#restedSince > REST_S;
    if (rests && !this.#rested) this.data.gap();
    this.#rested = rests;
    return rests;
  }

  draw() {
    if (!this.view.frozen) {
      const last = this.data.times.at(-1) ?? 1;
      const span = Number(byId("span").value);
      this.view.whole = [Math.max(last - KEPT_S, this.data.times[0] ?? 0), last];
      this.view.range = [last - span, last];
    }
    const key = [this.data.times.length, this.data.times.at(-1), ...this.view.range, this.view.cursor, this.view.selection, devicePixelRatio,
      ...this.plots.map(({ canvas }) => `${canvas.clientWidth} ${canvas.clientHeight} ${inSight(canvas)}`)].join();
    if (key === this.#drawn) return;
    this.#drawn = key;
    for (const plot of this.plots) if (inSight(plot.canvas)) plot.draw(this.view);
  }
}
