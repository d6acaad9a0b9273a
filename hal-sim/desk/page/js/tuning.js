// Gains by hand: the loops as measured, what other gains would make of them, and those put in force.

import { figure } from "./steps.js";
import { byId, make } from "./dom.js";
import { Orders } from "./orders.js";

/** Rows of the gains, as the server has them for each pivot. */
const GAINS = [
  "position gain, 1/s", "velocity gain, V s/rad", "integral gain, V/rad",
  "notch 1: frequency, Hz (0: none)", "width, Hz", "gain at its middle",
  "notch 2: frequency, Hz (0: none)", "width, Hz", "gain at its middle",
  "lead from, Hz (0: none)", "to, Hz",
];
const PIVOTS = [0, 1, 2];

const cell = (text, properties = {}) => make("td", { textContent: text, ...properties });
const heads = (texts) => make("tr", {}, ...texts.map((text) => make("th", { scope: "col", textContent: text })));

export class Tuning {
  #tuning = null;
  #fields = [];
  #plots = "";
  #measured = "";

  constructor(operator, firstMove) {
    for (const name of ["measure", "predict", "put", "keep", "back", "said", "worth", "gains", "plots"]) this[name] = byId(`tuning-${name}`);
    this.orders = new Orders("commissioning", operator, firstMove, this.said);
    this.measure.addEventListener("click", () => this.orders.give(() => "measure", true));
    this.predict.addEventListener("click", () => this.orders.give(() => ({ predict: { gains: this.#typed() } }), false));
    this.put.addEventListener("click", () => this.orders.give(() => ({ put: { gains: this.#typed() } }), true));
    this.keep.addEventListener("click", () => this.orders.give(() => "keep", false));
    this.back.addEventListener("click", () => this.#fill(this.#tuning.gains));
    this.#fields = GAINS.map((name) => PIVOTS.map((pivot) => make("input", { inputMode: "decimal", autocomplete: "off", disabled: true, "aria-label": `${name}, pivot ${pivot + 1}` })));
    const rows = GAINS.map((name, row) => make("tr", {}, make("th", { scope: "row", textContent: name }), ...this.#fields[row].map((field) => make("td", {}, field))));
    this.gains.replaceChildren(heads(["gains and filters", ...PIVOTS.map((pivot) => `pivot ${pivot + 1}`)]), ...rows);
    operator.addEventListener("commissioning", ({ detail }) => this.#show(detail));
  }

  /** Numbers of each pivot. */
  #typed() {
    return PIVOTS.map((pivot) => this.#fields.map((row, index) => {
      const number = Number(row[pivot].value.trim().replace(",", "."));
      const sound = row[pivot].value.trim() !== "" && Number.isFinite(number) && number >= 0;
      row[pivot].setAttribute("aria-invalid", String(!sound));
      if (!sound) throw new Error(`${GAINS[index]} of pivot ${pivot + 1} is no number`);
      return number;
    }));
  }

  #fill(gains) {
    PIVOTS.forEach((pivot) => this.#fields.forEach((row, index) => {
      row[pivot].value = String(Number(gains[pivot][index].toPrecision(6)));
      row[pivot].removeAttribute("aria-invalid");
    }));
  }

  #show(status) {
    const { runs, tuning } = status;
    this.measure.disabled = runs;
    this.keep.disabled = runs;
    for (const button of [this.predict, this.put, this.back]) button.disabled = runs || !tuning;
    this.orders.say(status);
    this.#tuning = tuning;
    if (!tuning) return;
    for (const field of this.#fields.flat()) field.disabled = false;
    // A new measurement brings its own gains; what was typed since the last one stays.
    const measured = JSON.stringify([tuning.gains, tuning.measured]);
    if (measured !== this.#measured) {
      this.#measured = measured;
      this.#fill(tuning.gains);
    }
    this.#worth(tuning);
    const plots = [...(tuning.tried?.plots ?? []), ...tuning.plots];
    const paths = plots.map(({ path }) => path).join();
    if (paths === this.#plots) return;
    this.#plots = paths;
    this.plots.replaceChildren(...plots.map(figure));
  }

  #worth({ measured, tried, most_ms: most }) {
    const row = (kind) => ({ place, ms, rejection, crossover_hz: crossover }) => make("tr", {},
      make("th", { scope: "row", textContent: `${kind}, ${place}` }), cell(ms.toFixed(2), { className: ms <= most ? "good" : "bad" }),
      cell(rejection.toFixed(3)), cell(crossover.toFixed(0)));
    const unstable = tried && !tried.is_stable
      ? [make("tr", {}, make("td", { colSpan: 4, className: "bad", textContent: "With these gains the model of this machine is unstable." }))]
      : [];
    this.worth.replaceChildren(heads(["loop", `Ms (at most ${most})`, "S at 30 Hz", "crossover, Hz"]),
      ...measured.map(row("measured")), ...(tried ? tried.loops.map(row("with these gains")) : []), ...unstable);
  }
}
