// What a screen reader says by itself: the state once it lasts, not every change of it.

import { byId, setText } from "./dom.js";
import { shown } from "./gcs.js";

/** A state that is over sooner is not told. */
const LASTS_MS = 900;
const LOOK_MS = 300;

export function announce(stage) {
  const output = byId("announcement");
  let state = "";
  let since = 0;
  setInterval(() => {
    const now = stage.link.freshness.stale ? "" : words(stage);
    if (now !== state) {
      state = now;
      since = performance.now();
    } else if (performance.now() - since > LASTS_MS) {
      setText(output, state);
    }
  }, LOOK_MS);
}

function words({ connected, referenced, mode, settled, target }) {
  if (!connected) return "";
  if (!referenced) return "not referenced";
  if (mode === "holding" && settled) return `on target: x ${shown(target[0], 2)}, y ${shown(target[1], 2)}, theta ${shown(target[2], 2)}`;
  return { off: "servo off", holding: "holding", moving: "moving", stopping: "stopping at a fault", fault: "fault", exciting: "a motor is excited (EXC)" }[mode] ?? "";
}
