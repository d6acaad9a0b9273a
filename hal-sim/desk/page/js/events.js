// What has happened, as the controller remembers it: faults first of all, and the record of the ticks around the last.

import { byId, make, report, save, setText } from "./dom.js";
import { shown } from "./gcs.js";

export function events(stage) {
  const [box, list, all, said, count] = ["events", "events-list", "events-all", "events-said", "events-count"].map(byId);
  const { link } = stage;
  const show = async () => {
    if (!box.open || !stage.connected) return;
    await report(said, async () => {
      const entries = (await link.ask("EVT?") ?? "").split("\n").filter(Boolean).map(read).reverse();
      const faults = entries.filter(({ text }) => text.startsWith("fault: "));
      const chosen = all.checked ? entries : faults;
      const now = stage.now?.time ?? 0;
      list.replaceChildren(...chosen.map(({ number, tick, text }) => make("tr", { className: text.startsWith("fault: ") ? "fault" : "" },
        make("td", { textContent: number }), make("td", { textContent: ago(now - tick * stage.period) }), make("td", { textContent: text }))));
      setText(count, faults.length ? `${faults.length} ${faults.length === 1 ? "fault" : "faults"} among the last ${entries.length} events` : `no fault among the last ${entries.length} events`);
    });
  };
  byId("events-record").addEventListener("click", () => report(said, async () => {
    const record = await link.ask("FLR?").catch((error) => { throw new Error(error.number === 77 ? "there is no fault record" : error.message); });
    save("fault-record.txt", record, "text/plain");
  }, "saved"));
  byId("events-again").addEventListener("click", show);
  all.addEventListener("change", show);
  box.addEventListener("toggle", show);
  let fault = "";
  stage.addEventListener("slow", () => {
    if (stage.fault !== fault) show();
    fault = stage.fault;
  });
  stage.addEventListener("link", () => {
    box.hidden = !stage.knows("EVT?");
    show();
  });
}

/** Number, tick and words of a line. */
function read(line) {
  const [number, tick, ...words] = line.split(" ");
  return { number, tick: Number(tick), text: words.join(" ") };
}

/** By the controller's time. One from before a restart lies ahead of it. */
function ago(seconds) {
  if (seconds < 0) return "before a restart";
  if (seconds < 120) return `${shown(seconds, 1)} s ago`;
  return `${shown(seconds / 60, 0)} min ago`;
}
