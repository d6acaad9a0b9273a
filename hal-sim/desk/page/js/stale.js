// No new status: everything is dimmed, and it is said for how long.

import { byId, setText } from "./dom.js";

const LOOK_MS = 100;
const TITLE = document.title;

export function showStale(stage) {
  const { freshness } = stage.link;
  const [box, text, age] = [byId("stale"), byId("stale-text"), byId("stale-age")];
  const show = () => {
    const { stale } = freshness;
    document.body.classList.toggle("stale", stale);
    box.hidden = !stale;
    if (!stale) {
      if (document.title !== TITLE) document.title = TITLE;
      return;
    }
    document.title = `⚠ no status – ${TITLE}`;
    setText(text, stage.connected ? "No status from the controller: what is shown is old, the stage may move." : stage.reason || "Connecting…");
    setText(age, stage.seen ? `Last status ${freshness.age.toFixed(1)} s ago.` : "");
  };
  freshness.addEventListener("change", show);
  stage.addEventListener("link", show);
  setInterval(() => { if (freshness.stale) show(); }, LOOK_MS);
  show();
}
