// Scripts of GCS lines that run in the server: loaded, edited, run, stepped through, paused and ended from here.

import { byId, make, report, save, setText } from "./dom.js";
import { remember, remembered } from "./remembered.js";

const UNTITLED = "untitled";
/** Longest wait for an example. */
const PATIENCE_MS = 2000;
const BUSY = ["running", "pausing", "paused"];
const WORDS = { idle: "", running: "running", pausing: "pauses after this line", paused: "paused", ended: "" };

export class SequencePanel {
  #status = { state: "idle" };
  #listed = "";

  constructor(operator, firstMove) {
    Object.assign(this, { operator, firstMove });
    for (const name of ["name", "text", "lines", "run", "step", "pause", "end", "said", "report", "state"]) this[name] = byId(`sequence-${name}`);
    this.text.value = remembered("sequence", "");
    this.name.value = remembered("sequence-name", UNTITLED);
    this.text.addEventListener("change", () => remember("sequence", this.text.value));
    this.name.addEventListener("change", () => remember("sequence-name", this.name.value));
    this.run.addEventListener("click", () => this.#give(() => (this.#paused ? "continue" : { run: this.#script() })));
    this.step.addEventListener("click", () => this.#give(() => (this.#paused ? "step" : { first: this.#script() })));
    this.pause.addEventListener("click", () => this.#give(() => "pause"));
    this.end.addEventListener("click", () => this.#give(() => "stop"));
    this.#files();
    operator.addEventListener("sequence", ({ detail }) => this.#show(detail));
  }

  get #paused() {
    return this.#status.state === "paused";
  }

  #script() {
    if (!this.text.value.trim()) throw new Error("nothing to run: the script is empty");
    return { name: this.name.value.trim() || UNTITLED, text: this.text.value };
  }

  async #give(order) {
    const taken = await report(this.said, async () => {
      const wanted = order();
      if (wanted !== "pause" && wanted !== "stop") await this.firstMove.agree();
      await this.operator.order(wanted);
    });
    // What the sequence has said meanwhile stays.
    if (taken) this.#say(this.#status);
  }

  #say({ good, said }) {
    this.said.className = `said ${good ? "good" : "bad"}`;
    setText(this.said, said);
  }

  #files() {
    const file = byId("sequence-file");
    byId("sequence-open").addEventListener("click", () => file.click());
    file.addEventListener("change", async () => {
      const [chosen] = file.files;
      if (chosen) this.#load(chosen.name, await chosen.text());
      file.value = "";
    });
    byId("sequence-save").addEventListener("click", () => {
      const name = this.name.value.trim() || UNTITLED;
      save(name.endsWith(".gcs") ? name : `${name}.gcs`, this.text.value, "text/plain");
    });
    const examples = byId("sequence-example");
    examples.addEventListener("change", () => report(this.said, async () => {
      const name = examples.value;
      examples.value = "";
      const response = await fetch(`/examples/${name}`, { signal: AbortSignal.timeout(PATIENCE_MS) });
      if (!response.ok) throw new Error(`there is no example ${name}`);
      this.#load(name, await response.text());
    }));
  }

  #load(name, text) {
    Object.assign(this.name, { value: name });
    Object.assign(this.text, { value: text });
    remember("sequence", text);
    remember("sequence-name", name);
  }

  #show(status) {
    const before = this.#status;
    this.#status = status;
    const { state, name, line, done, total, said } = status;
    const busy = BUSY.includes(state);
    this.text.hidden = busy;
    this.lines.hidden = !busy;
    for (const field of [this.name, byId("sequence-open"), byId("sequence-example")]) field.disabled = busy;
    this.run.disabled = busy && state !== "paused";
    this.step.disabled = this.run.disabled;
    this.pause.disabled = state !== "running";
    this.end.disabled = !busy;
    setText(this.run, state === "paused" ? "Continue" : "Run");
    setText(this.state, busy ? `${name}: ${WORDS[state]}, line ${line}; ${done} of ${total} lines done` : "");
    if (busy) this.#list(status);
    else if (!this.text.value && status.text) this.#load(name, status.text);
    if (said || before.state !== state) this.#say(status);
    this.#report(status);
  }

  #list({ text, line }) {
    if (this.#listed !== text || !this.lines.childElementCount) {
      this.#listed = text;
      this.lines.replaceChildren(...text.trimEnd().split("\n").map((one) => make("li", { textContent: one || " " })));
    }
    this.lines.querySelector("[aria-current]")?.removeAttribute("aria-current");
    const current = this.lines.children[line - 1];
    if (!current) return;
    current.setAttribute("aria-current", "step");
    // Within the list: the page itself is not to run away.
    this.lines.scrollTop = current.offsetTop - this.lines.clientHeight / 2;
  }

  #report({ answers, state }) {
    this.report.hidden = !answers?.length;
    if (!answers?.length || (state === "running" && this.report.childElementCount === answers.length + 1)) return;
    const head = make("tr", {}, ...["line", "asked", "answer"].map((text) => make("th", { scope: "col", textContent: text })));
    const rows = answers.map(({ number, line, reply }) => make("tr", {},
      make("td", { textContent: String(number) }), make("th", { scope: "row", textContent: line }), make("td", { className: "mono answer", textContent: reply })));
    this.report.replaceChildren(head, ...rows);
  }
}
