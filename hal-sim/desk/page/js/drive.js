// Reference, servo, target, speed, halt and stop.

import { byId, report } from "./dom.js";
import { plain, typed } from "./gcs.js";

const AXES = { x: "X", y: "Y", w: "W" };
const NAMES = { x: "x", y: "y", w: "θ" };

export function drive(stage) {
  const { link } = stage;
  const said = byId("said");
  const say = (action, done) => report(said, action, done);

  const stop = () => say(() => link.ask("STP"), "stopped");
  byId("stop").addEventListener("click", stop);
  // In the capturing phase: nothing in the page can keep it from acting.
  addEventListener("keydown", (event) => {
    if (event.key === "Escape") stop();
  }, { capture: true });

  byId("halt").addEventListener("click", () => say(async () => {
    // Halting reports error 10 as it is meant to.
    await link.ask("HLT").catch((error) => { if (error.number !== 10) throw error; });
  }, "halted"));
  byId("reference").addEventListener("click", () => say(() => link.ask("FRF"), "referenced"));

  const servo = byId("servo");
  servo.addEventListener("click", () => say(() => link.ask(`SVO X ${stage.servo ? 0 : 1}`), stage.servo ? "servo off" : "servo on"));
  stage.addEventListener("slow", () => servo.setAttribute("aria-pressed", String(stage.servo)));

  byId("target").addEventListener("submit", (event) => {
    event.preventDefault();
    say(() => link.ask(`MOV ${entered(AXES)}`), "on its way");
  });
  byId("home").addEventListener("click", () => say(() => link.ask("MOV X 0 Y 0 W 0"), "on its way"));

  byId("speed").addEventListener("submit", (event) => {
    event.preventDefault();
    say(() => link.ask(`VLS ${plain(number("vls", "speed"))}`), "speed set");
  });
  stage.addEventListener("slow", () => {
    byId("vls-now").textContent = `${stage.velocity} mm/s`;
    // Once: afterwards it is the person's own.
    if (!byId("vls").dataset.known) Object.assign(byId("vls"), { value: String(stage.velocity) }).dataset.known = "yes";
  });
}

/** The fields as pairs of axis and number. */
function entered(axes) {
  return Object.entries(axes).map(([id, axis]) => `${axis} ${plain(number(id, NAMES[id]))}`).join(" ");
}

/** The number in a field; throws with its name, and marks it, when there is none. */
export function number(id, name) {
  const field = byId(id);
  const value = typed(field.value);
  const good = Number.isFinite(value);
  field.setAttribute("aria-invalid", String(!good));
  if (!good) throw new Error(`${name}: “${field.value}” is not a number`);
  return value;
}
