// What the control loop says of itself.

import { byId, make, report } from "./dom.js";
import { fields, shown } from "./gcs.js";
import { facts } from "./table.js";

/** What pivot it is of, at the end of a name. */
const OF_PIVOT = /^([A-Z_]+)([123])$/;
const LEARNT_UNITS = ["V s/rad", "V/(N m)", "V", "V s/rad"];

/** Cycles of the processor in a microsecond. */
const CYCLES_PER_US = 168;

const us = (cycles) => (Number(cycles) ? `${shown(cycles / CYCLES_PER_US, 2)} µs` : "not measured here");
const NAMES = {
  TICKS: ["ticks", (value) => Number(value).toLocaleString("en")],
  CYCLES_LAST: ["last tick took", us],
  CYCLES_MEAN: ["mean", us],
  CYCLES_WORST: ["worst", us],
  LATE: ["late ticks", String],
  PEAK_ERROR_RAD: ["largest following error of a pivot since last looked", (value) => `${shown(value * 1e6, 2)} µrad`],
  COMMANDS: ["commands taken by the loop", String],
  REFUSED: ["of them refused", String],
  LOOSENED: ["thresholds of supervision looser than the reference", String],
};
const PIVOT_NAMES = {
  LEARNT: ["has learnt: rate, torque, friction, motor constant", (value) =>
    value.split(" ").map((part, i) => `${shown(Number(part), 5)} ${LEARNT_UNITS[i]}`).join(", ")],
  INTEGRAL: ["integral", (value) => `${shown(Number(value), 4)} V`],
  CURRENT: ["motor current by the model", (value) => `${shown(Number(value), 4)} A`],
  DRIVE: ["motor constant over its parameter; offset of the current sensor; friction over its parameters", (value) => {
    const [ratio, offset, friction] = value.split(" ").map(Number);
    return `${shown(ratio, 3)}; ${shown(offset, 2)} A; ${shown(friction, 2)} N m`;
  }],
};

function named(name) {
  const [, kind, pivot] = OF_PIVOT.exec(name) ?? [];
  const [text, show] = NAMES[name] ?? PIVOT_NAMES[kind] ?? [name, String];
  return [PIVOT_NAMES[kind] ? `pivot ${pivot}: ${text}` : text, show];
}

export function statistics(stage) {
  const [box, body] = [byId("statistics"), byId("statistics-body")];
  const numbers = make("div");
  const said = make("p", { className: "said", role: "status" });
  const again = make("button", { type: "button", className: "quiet", textContent: "Start again" });
  again.addEventListener("click", () => report(said, () => stage.link.ask("LST"), "started again"));
  body.append(numbers, again, said);
  stage.addEventListener("link", () => { box.hidden = !stage.knows("LST?"); });
  stage.addEventListener("slow", () => {
    const reply = stage.replies["LST?"];
    if (!box.open || !reply) return;
    const rows = Object.entries(fields(reply)).map(([name, value]) => {
      const [text, show] = named(name);
      return [text, show(value)];
    });
    numbers.replaceChildren(facts(rows));
  });
}
