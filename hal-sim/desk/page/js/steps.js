// A list of steps with what each has found.

import { make, setText } from "./dom.js";

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

/** A file of the server: to be looked at, or to be saved. */
export function fileLink(path, text, isSaved) {
  return make("a", { href: path, textContent: text, ...(isSaved ? { download: path.split("/").at(-1) } : { target: "_blank", rel: "noopener" }) });
}

export class StepList {
  /** What each step's item shows, so that one that is open stays so. */
  #shown = [];

  constructor(list) {
    this.list = list;
  }

  show(steps) {
    const same = steps.length === this.#shown.length && steps.every(({ name }, k) => name === this.#shown[k].name);
    if (!same) {
      this.#shown = steps.map(({ name, about }) => {
        const [time, body] = [make("span", { className: "faint small" }), make("div")];
        const summary = make("summary", {}, make("b", { textContent: name }), make("span", { className: "small grow", textContent: about }), time);
        return { name, time, body, said: "", isShown: false, item: make("li", {}, make("details", {}, summary, body)) };
      });
      this.list.replaceChildren(...this.#shown.map(({ item }) => item));
    }
    steps.forEach((step, k) => this.#step(step, this.#shown[k]));
    const runs = steps.findIndex(({ state }) => state === "runs");
    this.#shown.slice(0, Math.max(runs, 0)).forEach((shown) => {
      if (shown.isShown) shown.item.firstElementChild.open = false;
      shown.isShown = false;
    });
  }

  #step(step, shown) {
    const said = JSON.stringify(step);
    if (said === shown.said) return;
    shown.said = said;
    shown.item.dataset.state = step.state;
    const ended = step.state === "done" || step.state === "failed";
    setText(shown.time, ended ? `${step.seconds.toFixed(1)} s` : "");
    const failure = step.failure
      ? [make("p", { className: "said bad", textContent: step.failure.what }), make("p", { textContent: `What to do: ${step.failure.advice}.` })]
      : [];
    const found = ended || step.findings.length > 0;
    shown.body.replaceChildren(...(found ? [findings(step.findings)] : []), ...failure, ...step.plots.map(figure));
    // What fails is shown, and what is found while it is under way, until the next step is.
    if (step.state === "failed") shown.item.firstElementChild.open = true;
    if (step.state === "runs" && found && !shown.isShown) shown.isShown = shown.item.firstElementChild.open = true;
  }
}
