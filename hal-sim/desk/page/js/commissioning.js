// Commissioning from this page: which step is under way, what each has found, and what the person beside the machine is asked for.

import { byId, make, report, setText } from "./dom.js";
import { TaskPicture } from "./task-picture.js";

const WAITS = {
  turn: "The encoders tell when it is done; nothing has to be pressed.",
  jig: "Say so when it stands: nothing moves before.",
};
const SIMULATED = "The simulated machine’s simulated person does it.";

/** A plot with its caption. */
export function figure({ path, caption }) {
  return make("figure", {}, make("img", { src: path, alt: caption, loading: "lazy" }), make("figcaption", { textContent: caption }));
}

/** What a step has measured. */
function findings(all) {
  const rows = all.map(({ name, value, limit, passed }) => make("tr", {},
    make("th", { scope: "row", textContent: name }), make("td", { textContent: value }), make("td", { textContent: limit }),
    make("td", { className: passed ? "good" : "bad", textContent: limit || !passed ? (passed ? "ok" : "failed") : "" })));
  return make("table", { className: "list" }, ...rows);
}

export class Commissioning {
  #status = null;
  /** What each step's item shows, so that one that is open stays so. */
  #shown = [];
  #picture = new TaskPicture(byId("commission-picture"));

  constructor(operator, firstMove) {
    Object.assign(this, { operator, firstMove });
    for (const name of ["start", "from", "periods", "only", "tune", "undo", "end", "task", "words", "waits", "done", "said", "files", "steps"]) this[name] = byId(`commission-${name}`);
    this.withoutJig = byId("commission-without-jig");
    const from = () => (this.from.selectedIndex > 0 ? this.from.value : null);
    this.start.addEventListener("click", () => this.#give(() => ({ commission: { from: from(), scale_periods: this.#periods(), without_jig: this.withoutJig.checked } })));
    this.only.addEventListener("click", () => this.#give(() => ({ only: { step: this.from.value, scale_periods: this.#periods() } })));
    for (const order of ["tune", "undo", "end", "done"]) this[order].addEventListener("click", () => this.#give(() => order));
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

  async #give(order) {
    const taken = await report(this.said, async () => {
      const wanted = order();
      if (wanted !== "end" && wanted !== "done") await this.firstMove.agree();
      await this.operator.order({ commissioning: wanted });
    });
    if (taken) this.#say(this.#status);
  }

  #say(status) {
    if (!status?.what) return;
    this.said.className = `said ${status.good ? "good" : "bad"}`;
    setText(this.said, status.runs ? `${status.what}…` : `${status.what}: ${status.said}`);
  }

  #show(status) {
    this.#status = status;
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
    this.#say(status);
    this.#steps(status.steps);
    this.#files(status);
  }

  #steps(steps) {
    const same = steps.length === this.#shown.length && steps.every(({ name }, k) => name === this.#shown[k].name);
    if (!same) {
      this.#shown = steps.map(({ name, about }) => {
        const [time, body] = [make("span", { className: "faint small" }), make("div")];
        const summary = make("summary", {}, make("b", { textContent: name }), make("span", { className: "small grow", textContent: about }), time);
        return { name, time, body, said: "", item: make("li", {}, make("details", {}, summary, body)) };
      });
      this.steps.replaceChildren(...this.#shown.map(({ item }) => item));
    }
    steps.forEach((step, k) => {
      const shown = this.#shown[k];
      const said = JSON.stringify(step);
      if (said === shown.said) return;
      shown.said = said;
      shown.item.dataset.state = step.state;
      const ended = step.state === "done" || step.state === "failed";
      setText(shown.time, ended ? `${step.seconds.toFixed(1)} s` : "");
      const failure = step.failure
        ? [make("p", { className: "said bad", textContent: step.failure[0] }), make("p", { textContent: `What to do: ${step.failure[1]}.` })]
        : [];
      shown.body.replaceChildren(...(ended ? [findings(step.findings)] : []), ...failure, ...step.plots.map(figure));
      if (step.state === "failed") shown.item.firstElementChild.open = true;
    });
  }

  #files({ report: page, tables, before }) {
    const link = (path, text, isFile) => make("a", { href: path, textContent: text, ...(isFile ? { download: path.split("/").at(-1) } : { target: "_blank", rel: "noopener" }) });
    const all = [
      ...(page ? [link(page, "the report", false), link(page, "save it", true)] : []),
      ...tables.map((path) => link(path, path.split("/").at(-1), true)),
      ...(before ? [link(before, "settings as they were before", true)] : []),
    ];
    if (all.length !== this.files.childElementCount || (page && !this.files.querySelector(`[href="${page}"]`))) this.files.replaceChildren(...all);
  }

  /** At the screen's rate. */
  draw() {
    if (!this.task.hidden) this.#picture.draw();
  }
}
