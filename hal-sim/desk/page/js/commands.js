// The commands that the controller knows, as it tells them: searched, and put into the command line by a click.

import { byId, make } from "./dom.js";

export function commandHelp(stage) {
  const [list, search, line, box] = ["commands-list", "commands-search", "console-line", "commands"].map(byId);
  const show = () => {
    if (!box.open) return;
    const sought = search.value.trim().toLowerCase();
    const entries = stage.help.filter((entry) => entry.toLowerCase().includes(sought));
    list.replaceChildren(...entries.map((entry) => {
      const [word] = entry.split(" ");
      const button = make("button", { type: "button", className: "quiet mono", textContent: word });
      button.addEventListener("click", () => {
        line.value = `${word} `;
        line.focus();
      });
      return make("li", {}, button, make("span", { textContent: entry.slice(word.length) }));
    }));
  };
  search.addEventListener("input", show);
  box.addEventListener("toggle", show);
  stage.addEventListener("link", show);
}
