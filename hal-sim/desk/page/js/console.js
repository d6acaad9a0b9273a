// The command line: whatever the controller knows, and what it says.

import { byId } from "./dom.js";

const KEPT = 400;

export function commandLine(stage) {
  const [line, log] = [byId("console-line"), byId("console-log")];
  const history = [];
  let place = 0;
  const say = (text) => {
    log.append(`${text}\n`);
    while (log.childNodes.length > KEPT) log.firstChild.remove();
    log.scrollTop = log.scrollHeight;
  };
  byId("console-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    const text = line.value.trim();
    if (!text) return;
    history.push(text);
    place = history.length;
    line.value = "";
    say(`> ${text}`);
    try {
      const reply = await stage.link.ask(text);
      if (reply !== null) say(reply);
    } catch (error) {
      say(error.number ? `error ${error.number}: ${error.message}` : error.message);
    }
  });
  line.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    place = Math.min(Math.max(place + step, 0), history.length);
    line.value = history[place] ?? "";
  });
}
