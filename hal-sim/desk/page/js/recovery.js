// A stage that the controller refuses to reference because it stands out of its reach: driven back in as long as a button is held.

import { byId, report } from "./dom.js";
import { whileHeld } from "./held.js";

const OUT_OF_REACH = 4003;

export function recovery(stage) {
  const [box, said] = [byId("recovery"), byId("said")];
  const show = (visible) => { if (box.hidden === visible) box.hidden = !visible; };
  stage.link.addEventListener("error", ({ detail }) => { if (detail === OUT_OF_REACH && stage.knows("RCV")) show(true); });
  // In reach again, and held; or another controller.
  stage.addEventListener("slow", () => { if (stage.servo && stage.settled) show(false); });
  stage.addEventListener("link", () => show(false));
  whileHeld(byId("recover"), {
    begin: () => report(said, () => stage.link.ask("RCV 1"), "on its way back in"),
    renew: () => stage.link.ask("RCV 1"),
    end: () => report(said, () => stage.link.ask("RCV 0"), "released"),
  });
}
