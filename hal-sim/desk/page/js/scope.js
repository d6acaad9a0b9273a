// Following error and duty while the stage moves, scrolling; paused, they can be zoomed.

import { byId } from "./dom.js";
import { Envelope } from "./envelope.js";
import { Plot } from "./plot.js";
import { inSight } from "./view.js";
import { control, TimeView } from "./zoom.js";

const KEPT_S = 120;

export class Scope {
  constructor(stage) {
    this.stage = stage;
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
    if (this.view.frozen) return;
    const percent = duties.map((range) => range.map((value) => 100 * value));
    const all = [...errors, ...percent];
    this.data.add(time, all.map(([low]) => low), all.map(([, high]) => high));
  }

  draw() {
    if (!this.view.frozen) {
      const last = this.data.times.at(-1) ?? 1;
      const span = Number(byId("span").value);
      this.view.whole = [Math.max(last - KEPT_S, this.data.times[0] ?? 0), last];
      this.view.range = [last - span, last];
    }
    for (const plot of this.plots) if (inSight(plot.canvas)) plot.draw(this.view);
  }
}
