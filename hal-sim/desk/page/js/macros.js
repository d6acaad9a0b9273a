// Macros of the controller: run, looked at, written anew, deleted. They are recorded as a sequence, so that no line of anybody else
// gets between theirs.

import { byId, make, report } from "./dom.js";

const NAME = /^[A-Za-z][A-Za-z0-9_]*$/;

export function macros(stage, operator) {
  const { link } = stage;
  const [box, list, name, text, said] = ["macros", "macros-list", "macro-name", "macro-text", "macro-said"].map(byId);
  const act = async (line, done) => {
    await report(said, () => link.ask(line), done);
    show();
  };
  const button = (label, action) => {
    const made = make("button", { type: "button", className: "quiet", textContent: label });
    made.addEventListener("click", action);
    return made;
  };
  const edit = (one) => report(said, async () => {
    text.value = await link.ask(`MAC? ${one}`) ?? "";
    name.value = one;
  });
  const show = async () => {
    if (!box.open || !stage.connected) return;
    const names = (await link.ask("MAC?").catch(() => "") ?? "").split("\n").filter(Boolean);
    const rows = names.map((one) => make("tr", {}, make("th", { scope: "row", textContent: one }), make("td", {},
      button("Run", () => act(`MAC START ${one}`, `${one} runs`)), " ", button("Edit", () => edit(one)), " ",
      button("Delete", () => act(`MAC DEL ${one}`, `${one} is deleted`)))));
    const none = make("tr", {}, make("td", { textContent: "The controller has no macro yet." }));
    list.replaceChildren(...(rows.length ? rows : [none]));
  };
  byId("macro-save").addEventListener("click", async () => {
    await report(said, () => record(operator, name.value.trim(), text.value), `${name.value.trim()} is kept`);
    show();
  });
  byId("macro-end").addEventListener("click", () => act("MAC STOP", "the macro is ended; a motion under way goes on"));
  byId("macro-why").addEventListener("click", () => report(said, async () => {
    said.textContent = "";
    const why = await link.ask("MAC ERR?");
    throw new Error(why && !why.startsWith(" ") ? why : "no macro has failed");
  }));
  box.addEventListener("toggle", show);
  stage.addEventListener("link", () => {
    box.hidden = !stage.knows("MAC");
    show();
  });
}

/** Has a macro recorded by the server; what it came to. */
async function record(operator, name, text) {
  if (!NAME.test(name)) throw new Error("a name begins with a letter and has letters, digits and underscores only");
  const lines = text.split("\n").map((line) => line.trim()).filter(Boolean);
  if (!lines.length) throw new Error("nothing to keep: there are no lines");
  const title = `macro ${name}`;
  const ended = new Promise((resolve, reject) => {
    const look = ({ detail: { name: whose, state, good, said } }) => {
      if (state !== "ended" || whose !== title) return;
      operator.removeEventListener("sequence", look);
      if (good) resolve();
      else reject(new Error(said));
    };
    operator.addEventListener("sequence", look);
    setTimeout(() => reject(new Error("not kept: a sequence runs")), 2000);
  });
  await operator.order({ run: { name: title, text: ["MAC BEG " + name, ...lines, "MAC END"].join("\n") } });
  await ended;
}
