// Who did what: the lines of all pages of this server and of its sequences, and what came of them.

import { byId, make } from "./dom.js";
import { remember, remembered } from "./remembered.js";

const KEPT = 300;

export function log(operator, link) {
  const [list, who] = [byId("log-list"), byId("log-who")];
  const chance = `page ${Math.floor(Math.random() * 900 + 100)}`;
  who.value = remembered("who", chance);
  link.who = who.value;
  who.addEventListener("change", () => {
    who.value = who.value.trim() || chance;
    link.who = who.value;
    remember("who", who.value);
  });
  // All that is kept comes again with every connection.
  operator.addEventListener("opened", () => list.replaceChildren());
  operator.addEventListener("log", ({ detail: { at_ms: at, who: whose, line, outcome } }) => {
    const time = new Date(at).toLocaleTimeString("en-GB");
    list.prepend(make("tr", {}, ...[time, whose, line, outcome].map((text) => make("td", { textContent: text }))));
    while (list.childElementCount > KEPT) list.lastChild.remove();
  });
}
