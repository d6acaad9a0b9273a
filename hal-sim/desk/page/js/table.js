// Numbers in a table of two columns, for statistics and the like.

import { make } from "./dom.js";

/** Rows of a name and a value. */
export function facts(rows) {
  const body = rows.map(([name, value]) => make("tr", {}, make("th", { scope: "row", textContent: name }), make("td", { textContent: value })));
  return make("table", { className: "list" }, ...body);
}
