// Steps at a click; with a controller that knows JOG, motion as long as a button is held.

import { byId, report } from "./dom.js";
import { number } from "./drive.js";
import { plain } from "./gcs.js";
import { whileHeld } from "./held.js";

export function steps(stage) {
  const said = byId("said");
  const size = (axis) => (axis === "W" ? number("step-deg", "step in degrees") : number("step-mm", "step in mm"));
  const jogging = () => stage.knows("JOG") && byId("jog").checked;
  stage.addEventListener("link", () => { byId("jog-switch").hidden = !stage.knows("JOG"); });

  for (const button of document.querySelectorAll("[data-step]")) {
    const [axis, sign] = button.dataset.step;
    const amount = () => plain(size(axis) * (sign === "+" ? 1 : -1));
    let line = "";
    button.addEventListener("click", () => {
      if (!jogging()) report(said, () => stage.link.ask(`MVR ${axis} ${amount()}`), "on its way");
    });
    whileHeld(button, {
      allowed: jogging,
      begin: () => report(said, () => {
        line = `JOG ${axis} ${amount()}`;
        return stage.link.ask(line);
      }, "jogging"),
      renew: () => stage.link.ask(line),
      end: () => report(said, () => stage.link.ask(`JOG ${axis} 0`), "released"),
    });
  }
}
