// The parameters as the controller tells them, in its groups: searched, compared with the reference, set when they are left, undone,
// and kept over a restart.

import { byId, make, report, setText } from "./dom.js";
import { fields, typed } from "./gcs.js";
import { REFERENCE } from "./reference.js";

const COLUMNS = ["parameter", "value", "unit", "range", "reference", "level", "id"];
/** Of `WPA`; it guards against accidents, not against people. */
const KEEP = "WPA 100";
/** Numbers are kept in single precision. */
const SAME = 1e-6;

export function parameters(stage) {
  new Parameters(stage);
}

class Parameters {
  /** What was changed from here since it was kept: [key, name, value before]. */
  #changes = [];
  #rows = [];

  constructor(stage) {
    this.stage = stage;
    this.box = byId("parameters");
    this.said = make("p", { className: "said", role: "status" });
    this.list = make("div", { className: "scroll tall" });
    this.search = make("input", { type: "search", className: "name", placeholder: "search", autocomplete: "off", "aria-label": "Search parameters" });
    this.others = make("input", { type: "checkbox" });
    this.count = make("span", { className: "faint small" });
    this.undo = this.#button("Undo", () => this.#undo());
    this.keep = this.#button("Keep over a restart", () => this.#keep());
    this.back = this.#button("Back to what is kept", () => this.#recall());
    for (const input of [this.search, this.others]) input.addEventListener("input", () => this.#filter());
    byId("parameters-body").append(
      make("div", { className: "row" }, this.search, make("label", {}, this.others, " only what differs from the reference"), this.count),
      make("div", { className: "row" }, this.undo, this.keep, this.back),
      unlocking(stage, this.said), this.said, this.list);
    this.#showChanges();
    this.box.addEventListener("toggle", () => { if (this.box.open) this.#load(); });
    stage.addEventListener("link", () => { if (this.box.open && stage.connected) this.#load(); });
  }

  #button(text, action) {
    const button = make("button", { type: "button", className: "quiet", textContent: text });
    button.addEventListener("click", action);
    return button;
  }

  #load() {
    return report(this.said, async () => {
      const help = fields(await this.stage.link.ask("HPA?"));
      const values = fields(await this.stage.link.ask("SPA?"));
      const groups = new Map();
      this.#rows = [];
      for (const [id, line] of Object.entries(help)) {
        const about = described(line);
        if (!groups.has(about.group)) groups.set(about.group, []);
        const rows = Object.entries(values).filter(([key]) => key.split(" ")[1] === id).map(([key, value]) => this.#row(id, about, key, value));
        groups.get(about.group).push(...rows);
        this.#rows.push(...rows);
      }
      this.list.replaceChildren(...[...groups].map(([name, rows]) => table(name, rows)));
      this.#filter();
    });
  }

  /** A row; what it is searched by, and how to show another value, belong to it. */
  #row(id, { group, level, text, unit, range, settable }, key, value) {
    const [item] = key.split(" ");
    const name = item === "1" ? text : `${text} (${item})`;
    const reference = REFERENCE[Number(id)];
    const input = settable ? make("input", { value, inputMode: "decimal", autocomplete: "off", "aria-label": name }) : null;
    const told = make("td", { className: "faint" });
    const row = make("tr", {}, make("th", { scope: "row", textContent: name }),
      ...[input || value, unit, range].map((cell) => make("td", {}, cell)), told,
      make("td", { textContent: settable ? level : "read only" }), make("td", { className: "faint mono", textContent: id }));
    const entry = { row, key, name, input, value, words: `${name} ${group} ${id}`.toLowerCase() };
    entry.show = (now) => {
      entry.value = now;
      if (input) input.value = now;
      entry.differs = settable && reference !== undefined && Math.abs(Number(now) - reference) > SAME * Math.abs(reference);
      row.classList.toggle("differs", entry.differs);
      setText(told, entry.differs ? String(reference) : "");
    };
    entry.show(value);
    input?.addEventListener("change", () => this.#change(entry));
    return entry;
  }

  async #change(entry) {
    const { name, input, value: before } = entry;
    const good = await report(this.said, async () => {
      const wanted = typed(input.value);
      if (!Number.isFinite(wanted)) throw new Error(`${name}: “${input.value}” is not a number; nothing was changed`);
      await this.#set(entry, wanted);
      this.#changes.push([entry.key, name, before]);
    }, `${name}: set`);
    input.setAttribute("aria-invalid", String(!good));
    this.#showChanges();
  }

  /** Sets it, and shows what it is afterwards. */
  async #set(entry, wanted) {
    const { link } = this.stage;
    await link.ask(`SPA ${entry.key} ${wanted}`).catch((error) => {
      throw new Error(`${entry.name}: ${error.message}; nothing was changed`);
    });
    entry.show(fields(await link.ask(`SPA? ${entry.key}`))[entry.key]);
    this.#showCount();
  }

  async #undo() {
    const [key, name, before] = this.#changes.at(-1);
    const entry = this.#rows.find((one) => one.key === key);
    await report(this.said, async () => {
      await this.#set(entry, before);
      this.#changes.pop();
    }, `${name}: ${before} again`);
    this.#showChanges();
  }

  async #keep() {
    if (await report(this.said, () => this.stage.link.ask(KEEP), "kept: the controller starts with these values")) this.#changes = [];
    this.#showChanges();
  }

  async #recall() {
    if (!await report(this.said, () => this.stage.link.ask("RPA"))) return;
    this.#changes = [];
    this.#showChanges();
    if (await this.#load()) report(this.said, async () => {}, "all parameters are what was kept");
  }

  #showChanges() {
    const last = this.#changes.at(-1);
    this.undo.disabled = !last;
    setText(this.undo, last ? `Undo: ${last[1]} back to ${last[2]}` : "Undo");
    this.#showCount();
  }

  #showCount() {
    const differing = this.#rows.filter(({ differs }) => differs).length;
    const changed = this.#changes.length ? `; ${this.#changes.length} changed here and not kept` : "";
    setText(this.count, `${differing} ${differing === 1 ? "differs" : "differ"} from the reference${changed}`);
  }

  #filter() {
    const sought = this.search.value.trim().toLowerCase();
    for (const { row, words, differs } of this.#rows) row.hidden = !words.includes(sought) || (this.others.checked && !differs);
    for (const group of this.list.children) group.hidden = !group.querySelector("tbody tr:not([hidden])");
    this.#showCount();
  }
}

/** The rows of a group under its name. */
function table(name, entries) {
  const head = make("tr", {}, ...COLUMNS.map((text) => make("th", { textContent: text, scope: "col" })));
  return make("section", {}, make("h3", { textContent: name }),
    make("table", { className: "list parameters" }, make("thead", {}, head), make("tbody", {}, ...entries.map(({ row }) => row))));
}

/** What a line of `HPA?` says: level, group, text, unit, range, and whether it can be set at all. */
function described(line) {
  const [level, , , group, whole] = line.split("\t");
  const range = /, (\S+ to \S+)$/.exec(whole)?.[1] ?? "";
  const rest = whole.replace(/ \(read only\)$/, "").slice(0, range ? -(range.length + 2) : undefined);
  const unit = /, (track radii|encoder counts|[^ ,]{1,12}(?: [^ ,]*[/^][^ ,]*)?)$/.exec(rest)?.[1] ?? "";
  const text = unit ? rest.slice(0, -(unit.length + 2)) : rest;
  return { level, group, text, unit, range, settable: range !== "" };
}

/** The password that lets parameters of a higher level be set. */
function unlocking(stage, said) {
  const word = make("input", { type: "password", className: "name", autocomplete: "off", "aria-label": "Password of level 1" });
  const button = make("button", { type: "submit", className: "quiet", textContent: "Unlock level 1" });
  const form = make("form", { className: "row" }, make("label", {}, "password ", word), button,
    make("span", { className: "faint small", textContent: "Level 1 can break a machine. It is unlocked for this page alone, until it is closed." }));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    report(said, () => stage.link.ask(`CCL 1 ${word.value.trim()}`), "level 1 is unlocked");
  });
  return form;
}
