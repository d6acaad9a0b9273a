// The data recorder: what, how often, armed by what; fetched, looked at, saved. The controller tells what there is to record.

import { byId, make, report, save, setText } from "./dom.js";
import { fields, plain, typed } from "./gcs.js";
import { Plot } from "./plot.js";
import { sections, table } from "./record.js";
import { control, TimeView } from "./zoom.js";

/** Ready-made choices of sources and options. */
const PRESETS = {
  "pose, set and measured": ["X 1", "X 2", "Y 1", "Y 2", "W 1", "W 2"],
  "errors of the pivots": ["1 3", "2 3", "3 3", "0 202"],
  "errors of the pose": ["X 3", "Y 3", "W 3", "0 202"],
  "duties and currents": ["1 73", "2 73", "3 73", "1 200", "2 200", "3 200"],
  "integrals, currents by the model": ["1 205", "2 205", "3 205", "1 206", "2 206", "3 206"],
  "what pivot 1 has learnt": ["1 3", "1 205", "1 207", "1 208", "1 209"],
  "what pivot 2 has learnt": ["2 3", "2 205", "2 207", "2 208", "2 209"],
  "what pivot 3 has learnt": ["3 3", "3 205", "3 207", "3 208", "3 209"],
};
/** Tables that record nothing. */
const OFF = "0 0";
/** The trigger that is offered first: the next command that moves. */
const NEXT_MOVE = "2";
/** Triggers that need a value: the first table crosses it. */
const CROSSINGS = ["100", "101"];
/** Ticks from point to point that are offered first: a second or so in all. */
const EVERY = 10;
/** Points asked for at a time, so that a slow line shows the status in between. */
const POINTS = 128;
/** Item and parameter that say how many points make a record. */
const POINTS_OF_A_RECORD = "1 0x16000201";
/** How often the progress is asked for, ms. */
const LOOK_MS = 250;
const PAINTS = ["pivot-1", "pivot-2", "pivot-3", "centre", "theta", "ink", "faint", "steel"];

export class Recorder {
  #tables = 0;
  #armings = 0;
  #rows = null;

  constructor(stage) {
    this.stage = stage;
    this.box = byId("recorder");
    stage.addEventListener("link", () => {
      this.box.hidden = !["DRC", "DRT", "DRR?", "HDR?"].every((word) => stage.knows(word));
    });
    this.box.addEventListener("toggle", () => { if (this.box.open && !this.#tables) this.#build(); });
  }

  async #build() {
    this.said = make("p", { className: "said", role: "status" });
    const body = byId("recorder-body");
    body.replaceChildren(this.said);
    await report(this.said, async () => {
      const { link } = this.stage;
      const help = sections(await link.ask("HDR?"));
      this.#tables = Number(await link.ask("TNR?"));
      this.options = help.RecordOptions;
      body.prepend(this.#form(help), this.#pictures());
    });
  }

  #form(help) {
    const choice = (entries, properties) => make("select", properties, ...entries.map(([value, text]) => make("option", { value, textContent: text })));
    this.preset = choice([...Object.keys(PRESETS).map((name) => [name, name]), ["", "as it is set"]], { "aria-label": "What is recorded" });
    this.every = make("input", { value: String(EVERY), inputMode: "decimal", autocomplete: "off" });
    this.trigger = choice(Object.entries(help.TriggerOptions), { "aria-label": "What begins the record" });
    this.trigger.value = NEXT_MOVE;
    this.value = make("input", { value: "0", inputMode: "decimal", autocomplete: "off" });
    const arm = make("button", { type: "submit", textContent: "Arm" });
    this.fetch = make("button", { type: "button", textContent: "Fetch" });
    this.keep = make("button", { type: "button", textContent: "Save as CSV", className: "quiet", disabled: true });
    this.fetch.addEventListener("click", () => report(this.said, () => this.#fetch(), "fetched"));
    this.keep.addEventListener("click", () => this.#save());
    const value = make("label", { hidden: true }, "of the first table, at ", this.value);
    this.trigger.addEventListener("change", () => { value.hidden = !CROSSINGS.includes(this.trigger.value); });
    const form = make("form", { className: "row" },
      make("label", {}, "record ", this.preset), make("label", {}, "every ", this.every, " ticks"),
      make("label", {}, "begun by ", this.trigger), value, arm, this.fetch, this.keep);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      report(this.said, () => this.#arm(), "armed: it begins with its trigger").then((good) => { if (good) this.#watch(); });
    });
    return form;
  }

  #pictures() {
    this.pictures = make("div");
    this.plots = [];
    this.view = new TimeView(0, 1);
    this.view.addEventListener("change", () => this.#draw());
    addEventListener("resize", () => this.#draw());
    return this.pictures;
  }

  async #arm() {
    const { link } = this.stage;
    const ticks = typed(this.every.value);
    if (!Number.isInteger(ticks) || ticks < 1) throw new Error(`“${this.every.value}” is no whole number of ticks`);
    await link.ask(`RTR ${ticks}`);
    const wanted = PRESETS[this.preset.value];
    if (wanted) {
      const all = Array.from({ length: this.#tables }, (_, i) => `${i + 1} ${wanted[i] ?? OFF}`);
      await link.ask(`DRC ${all.join(" ")}`);
    }
    await link.ask(`DRT 1 ${this.trigger.value} ${plain(typed(this.value.value) || 0)}`);
  }

  /** Tells how far the record is until it is complete, armed anew, or out of sight. */
  async #watch() {
    const arming = ++this.#armings;
    const watched = () => this.box.open && arming === this.#armings;
    const sought = await this.stage.link.ask(`SPA? ${POINTS_OF_A_RECORD}`).catch(() => "");
    const complete = Number(fields(sought)[POINTS_OF_A_RECORD]);
    while (watched()) {
      const points = await this.#points().catch(() => NaN);
      if (Number.isNaN(points) || !watched()) return;
      setText(this.said, points ? `${points} of ${complete} points so far` : "armed: waiting for its trigger");
      if (points >= complete) {
        this.fetch.click();
        return;
      }
      await new Promise((resolve) => setTimeout(resolve, LOOK_MS));
    }
  }

  async #points() {
    return Math.max(0, ...Object.values(fields(await this.stage.link.ask("DRL?"))).map(Number));
  }

  async #fetch() {
    const { link } = this.stage;
    const total = await this.#points();
    if (!total) throw new Error("nothing is recorded yet");
    this.#rows = null;
    for (let first = 1; first <= total; first += POINTS) {
      const part = table(await link.ask(`DRR? ${first} ${Math.min(POINTS, total - first + 1)}`));
      if (this.#rows) this.#rows.values.forEach((values, i) => values.push(...part.values[i]));
      else this.#rows = part;
      setText(this.said, `${Math.min(first + POINTS - 1, total)} of ${total} points`);
    }
    this.keep.disabled = false;
    this.#show();
  }

  #show() {
    const { names, values, period } = this.#rows;
    const times = values[0].map((_, i) => i * period);
    const data = { times, low: values, high: values };
    this.plots = [...byUnit(names)].map(([unit, series]) => this.#plot(unit, series, data));
    this.pictures.replaceChildren(...this.plots.map(({ canvas }) => canvas));
    this.view.whole = [0, times.at(-1) || period];
    this.view.all();
  }

  #plot(unit, series, data) {
    const title = unit ? `Record, ${unit}` : "Record";
    const canvas = make("canvas", { className: "plot", tabIndex: 0, role: "img", "aria-label": `${title}, over time` });
    const plot = new Plot(canvas, { title, series, data, decimals: 5 });
    control(canvas, this.view, (x) => plot.timeAt(x, this.view.range));
    return plot;
  }

  #draw() {
    for (const plot of this.plots) plot.draw(this.view);
  }

  #save() {
    const { names, values, period } = this.#rows;
    const head = ["time_s", ...names.map((name) => `"${name.replaceAll('"', '""')}"`)].join(",");
    const lines = values[0].map((_, i) => [(i * period).toFixed(9), ...values.map((column) => column[i])].join(","));
    save("record.csv", `${[head, ...lines].join("\n")}\n`);
  }
}

/** Series of the columns, by their unit: the text after the last comma of a name, or none. */
function byUnit(names) {
  const units = new Map();
  names.forEach((whole, channel) => {
    const [, name, unit] = /^(.*), ([^,]*)$/.exec(whole) ?? [whole, whole, ""];
    if (!units.has(unit)) units.set(unit, []);
    units.get(unit).push({ name, short: String(channel + 1), paint: PAINTS[channel % PAINTS.length], channel });
  });
  return units;
}
