// Steps at a click; with a controller that knows JOG, motion as long as a button is held.

import { byId, report } from "./dom.js";
import { number } from "./drive.js";
import { plain } from "./gcs.js";

// A velocity ends 300 ms after it was asked for last: a page that dies does not let its button go.
const RENEWAL_MS = 100;

export function steps(stage) {
  const said = byId("said");
  const size = (axis) => (axis === "W" ? number("step-deg", "step in degrees") : number("step-mm", "step in mm"));
  const jogging = () => stage.knows("JOG") && byId("jog").checked;
  stage.addEventListener("link", () => { byId("jog-switch").hidden = !stage.knows("JOG"); });

  for (const button of document.querySelectorAll("[data-step]")) {
    const [axis, sign] = button.dataset.step;
    const amount = () => plain(size(axis) * (sign === "+" ? 1 : -1));
    const step = () => report(said, () => stage.link.ask(`MVR ${axis} ${amount()}`), "on its way");
    let renewal = 0;
    const hold = () => {
      button.classList.add("held");
      const line = `JOG ${axis} ${amount()}`;
      report(said, () => stage.link.ask(line), "jogging");
      clearInterval(renewal);
      renewal = setInterval(() => stage.link.ask(line).catch(() => clearInterval(renewal)), RENEWAL_MS);
    };
    const release = () => {
      clearInterval(renewal);
      if (!button.classList.contains("held")) return;
      button.classList.remove("held");
      report(said, () => stage.link.ask(`JOG ${axis} 0`), "released");
    };
    button.addEventListener("click", () => { if (!jogging()) step(); });
    button.addEventListener("pointerdown", (event) => {
      if (!jogging()) return;
      button.setPointerCapture(event.pointerId);
      hold();
    });
    for (const kind of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(kind, release);
    button.addEventListener("keydown", (event) => {
      if (jogging() && [" ", "Enter"].includes(event.key) && !event.repeat) hold();
    });
    button.addEventListener("keyup", release);
    // A page that nobody sees any more does not see a button let go.
    addEventListener("visibilitychange", () => { if (document.hidden) release(); });
  }
}
