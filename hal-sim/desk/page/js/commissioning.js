// Commissioning from this page: which step is under way, what each has found, and what the person beside the machine is asked for.

import { byId, make, setText } from "./dom.js";
import { Orders } from "./orders.js";
import { StepList, fileLink } from "./steps.js";
import { TaskPicture } from "./task-picture.js";

const WAITS = {
  turn: "The encoders tell when it is done; nothing has to be pressed.",
  jig: "Say so when it stands: nothing moves before.",
  out: "Nothing has to be pressed; hands off the rings.",
};
const SIMULATED = "The simulated machine’s simulated person does it.";

export class Commissioning {
  #steps = new StepList(byId("commission-steps"));
  #picture = new TaskPicture(byId("commission-picture"));

  constructor(operator, firstMove) {
    for (const name of ["start", "from", "periods", "also", "only", "tune", "undo", "end", "task", "words", "waits", "done", "said", "files"]) this[name] = byId(`commission-${name}`);
    this.orders = new Orders("commissioning", operator, firstMove, this.said);
    this.withoutJig = byId("commission-without-jig");
    const from = () => (this.from.selectedIndex > 0 ? this.from.value : null);
    this.start.addEventListener("click", () => this.orders.give(() => ({ commission: { from: from(), scale_periods: this.#periods(), without_jig: this.withoutJig.checked, also_carries_kg: this.#alsoCarries() } }), true));
    this.only.addEventListener("click", () => this.orders.give(() => ({ only: { step: this.from.value, scale_periods: this.#periods() } }), true));
    this.tune.addEventListener("click", () => this.orders.give(() => ({ tune: { also_carries_kg: this.#alsoCarries() } }), true));
    for (const order of ["undo", "end", "done"]) this[order].addEventListener("click", () => this.orders.give(() => order, order === "undo"));
    byId("commission-open").addEventListener("click", () => {
      byId("commissioning").open = true;
      byId("commissioning").scrollIntoView();
    });
    operator.addEventListener("commissioning", ({ detail }) => this.#show(detail));
  }

  /** Periods of the encoders' scale, where somebody has said them. */
  #periods() {
    const text = this.periods.value.trim();
    if (text && !/^[1-9]\d{0,6}$/.test(text)) throw new Error(`scale periods are a whole number, not ${text}`);
    return text ? Number(text) : null;
  }

  /** What the platform carries at times besides, kg. */
  #alsoCarries() {
    const text = this.also.value.trim();
    if (text && !/^\d{1,2}(\.\d+)?$/.test(text)) throw new Error(`what the platform also carries is a number of kg, not ${text}`);
    return Number(text);
  }

  #show(status) {
    const { runs, asks, before, all_steps: names } = status;
    if (this.from.childElementCount !== names.length) {
      this.from.replaceChildren(...names.map((name) => make("option", { textContent: name })));
    }
    for (const button of [this.start, this.only, this.tune]) button.disabled = runs;
    this.undo.disabled = runs || !before;
    this.end.disabled = !runs;
    this.task.hidden = !asks;
    this.#picture.task = asks?.task ?? "";
    if (asks) {
      setText(this.words, asks.words);
      setText(this.waits, asks.is_simulated ? SIMULATED : WAITS[asks.task]);
      this.done.hidden = !asks.waits;
    }
    this.orders.say(status);
    this.#steps.show(status.steps);
    this.#files(status);
  }

  #files({ report: page, tables, before }) {
    const all = [
      ...(page ? [fileLink(page, "the report", false), fileLink(page, "save it", true)] : []),
      ...tables.map((path) => fileLink(path, path.split("/").at(-1), true)),
      ...(before ? [fileLink(before, "settings as they were before", true)] : []),
    ];
    if (all.length !== this.files.childElementCount || (page && !this.files.querySelector(`[href="${page}"]`))) this.files.replaceChildren(...all);
  }

  /** At the screen's rate. */
  draw() {
    if (!this.task.hidden) this.#picture.draw();
  }
}
