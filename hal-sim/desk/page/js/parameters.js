// The parameters with their units and ranges, as the controller tells them; changed ones are set when they are left.

import { byId, make, report } from "./dom.js";
import { fields, typed } from "./gcs.js";

const COLUMNS = ["parameter", "value", "unit", "range", "level", "id"];

export function parameters(stage) {
  const [box, body] = [byId("parameters"), byId("parameters-body")];
  const said = make("p", { className: "said", role: "status" });
  const list = make("div", { className: "scroll" });
  const load = () => report(said, async () => {
    const help = fields(await stage.link.ask("HPA?"));
    const values = fields(await stage.link.ask("SPA?"));
    const rows = Object.entries(help).flatMap(([id, text]) => rowsOf(stage, said, id, described(text), values));
    const head = make("tr", {}, ...COLUMNS.map((text) => make("th", { textContent: text, scope: "col" })));
    list.replaceChildren(make("table", { className: "list parameters" }, head, ...rows));
  });
  body.append(unlocking(stage, said), said, list);
  box.addEventListener("toggle", () => { if (box.open) load(); });
  stage.addEventListener("link", () => { if (box.open && stage.connected) load(); });
}

/** What a line of `HPA?` says: level, text, unit, range, and whether it can be set at all. */
function described(line) {
  const [level, , kind, , whole] = line.split("\t");
  const range = /, (\S+ to \S+)$/.exec(whole)?.[1] ?? "";
  const rest = whole.replace(/ \(read only\)$/, "").slice(0, range ? -(range.length + 2) : undefined);
  const unit = /, (track radii|encoder counts|[^ ,]{1,12}(?: [^ ,]*[/^][^ ,]*)?)$/.exec(rest)?.[1] ?? "";
  const text = unit ? rest.slice(0, -(unit.length + 2)) : rest;
  return { level, kind, text, unit, range, settable: range !== "" };
}

/** The password that lets parameters of a higher level be set. */
function unlocking(stage, said) {
  const word = make("input", { type: "password", className: "mono", autocomplete: "off", "aria-label": "Password of level 1" });
  const button = make("button", { type: "submit", className: "quiet", textContent: "Unlock level 1" });
  const form = make("form", { className: "row" }, make("label", {}, "password ", word), button,
    make("span", { className: "faint small", textContent: "Level 1 can break a machine. It is unlocked for all viewers of this page." }));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    report(said, () => stage.link.ask(`CCL 1 ${word.value.trim()}`), "level 1 is unlocked");
  });
  return form;
}

/** A row for each item that has the parameter. */
function rowsOf(stage, said, id, { level, text, unit, range, settable }, values) {
  return Object.entries(values).filter(([key]) => key.split(" ")[1] === id).map(([key, value]) => {
    const [item] = key.split(" ");
    const name = item === "1" ? text : `${text} (${item})`;
    const cells = [settable ? field(stage, said, key, name, value) : value, unit, range, settable ? level : "read only"];
    return make("tr", {}, make("th", { scope: "row", textContent: name }), ...cells.map((cell) => make("td", {}, cell)),
      make("td", { className: "faint mono", textContent: id }));
  });
}

/** A field that sets the parameter, and shows what it is afterwards. */
function field(stage, said, key, name, value) {
  const input = make("input", { value, inputMode: "decimal", autocomplete: "off", "aria-label": name });
  input.addEventListener("change", async () => {
    const good = await report(said, async () => {
      const wanted = typed(input.value);
      if (!Number.isFinite(wanted)) throw new Error(`${name}: “${input.value}” is not a number; nothing was changed`);
      await stage.link.ask(`SPA ${key} ${wanted}`).catch((error) => {
        throw new Error(`${name}: ${error.message}; nothing was changed`);
      });
    }, `${name}: set`);
    input.setAttribute("aria-invalid", String(!good));
    if (good) input.value = fields(await stage.link.ask(`SPA? ${key}`))[key];
  });
  return input;
}
