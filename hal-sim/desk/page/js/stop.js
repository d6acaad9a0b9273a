// STOP: said to be sent when it was, and to have stopped the stage when a later status of the controller says so.

import { byId, setText } from "./dom.js";
import { fields } from "./gcs.js";

/** Longest time without that status, ms. */
const CONFIRMED_WITHIN_MS = 1000;
const AGAIN_MS = 100;
/** Modes in which nothing is driven any more. */
const AT_REST = ["off", "holding", "fault"];
const EMERGENCY = "NOT CONFIRMED: use the emergency stop";

export function stopping(stage) {
  const { link } = stage;
  const said = byId("stop-said");
  let attempt = 0;

  const say = (kind, text) => {
    said.hidden = false;
    said.dataset.kind = kind;
    // What has to be read at once interrupts; the rest waits until the reader has finished.
    said.setAttribute("role", kind === "bad" ? "alert" : "status");
    setText(said, text);
  };

  const stop = async () => {
    const own = ++attempt;
    link.dispatchEvent(new Event("stopping"));
    const begun = performance.now();
    const isLatest = () => own === attempt;
    const seconds = () => ((performance.now() - begun) / 1000).toFixed(2);
    say(link.open ? "sent" : "bad", link.open ? "stop sent" : `stop NOT SENT, not connected. ${EMERGENCY}`);
    const alarm = setTimeout(() => { if (isLatest()) say("bad", EMERGENCY); }, CONFIRMED_WITHIN_MS);
    const since = await sent(link, stage, isLatest);
    await rest(stage, since, isLatest);
    clearTimeout(alarm);
    if (isLatest()) say("good", `stopped, as the controller says ${seconds()} s later`);
  };

  byId("stop").addEventListener("click", stop);
  // In the capturing phase: nothing in the page can keep it from acting.
  addEventListener("keydown", (event) => {
    if (event.key === "Escape") stop();
  }, { capture: true });
  // What was said of a stop holds until something else is asked for.
  link.addEventListener("asked", () => { if (said.dataset.kind === "good") said.hidden = true; });
}

/** Sends the stop until the server has it; the controller's time, s, at which it had it for sure. */
async function sent(link, stage, isWanted) {
  let there = false;
  while (isWanted()) {
    try {
      if (!there) await link.urge("STP");
      there = true;
      // It goes the same way as the stop and behind it: its answer is later.
      return Number(fields(await link.urge("MON?")).TICK) * stage.period;
    } catch {
      await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    }
  }
  return NaN;
}

/** Until a status later than that has the stage at rest. */
function rest(stage, since, isWanted) {
  return new Promise((resolve) => {
    const look = () => {
      const { now, mode, resting } = stage;
      const rests = now && now.time > since && AT_REST.includes(mode) && resting;
      if (!rests && isWanted()) return;
      stage.removeEventListener("tick", look);
      resolve();
    };
    stage.addEventListener("tick", look);
  });
}
