// What is known of the stage, from the status messages. Everybody else in the page reads it here.

import { commands, fields, numbers } from "./gcs.js";

const PERIOD = "0xE000200";
const RADIUS = "0x54500200";
const GUIDE_START = "0x54500201";
const GUIDE_LENGTH = "0x54500202";
const SPEED = "0x54500100";
const TURN_DIRECTION = "0x54500110";
/** Field of `*IDN?` that a simulated controller has in place of a serial number. */
// Serial numbers: of the simulated controller, and "emulated" in hexadecimal, as the emulated chip has it.
const SIMULATED = /^(SIM$|656D756C61746564)/;
/** The geometry and limits of speed change by a command of somebody, seldom: so often they are asked for, ms. */
const GEOMETRY_EVERY_MS = 3000;
/** Over so long, in the controller's time, a stage is looked at to see whether it rests, s; and how little it may move. */
const REST_S = 0.05;
const REST_DEG_S = 0.2;

export class Stage extends EventTarget {
  connected = false;
  reason = "";
  place = "";
  identity = "";
  /** Whether the controller says that it is a simulated one. */
  simulated = false;
  /** Whether there has ever been a status. */
  seen = false;
  /** What `HLP?` says of each command. */
  help = [];
  /** Commands that the controller knows. */
  known = new Set();
  /** "off", "holding", "moving", "stopping" at a fault, "fault", or "exciting". */
  mode = "off";
  fault = "";
  /** What `FLT?` tells besides: supervision that is looser than the reference, kept values that are not in force. */
  notices = [];
  /** Why nothing drives, if the machine is not commissioned. */
  notCommissioned = "";
  referenced = false;
  servo = false;
  settled = false;
  /** Coordinates of the frame in force, mm and deg; null while unknown. */
  measured = null;
  target = null;
  velocity = NaN;
  /** Largest velocity that can be set, mm/s. */
  fastest = NaN;
  /** Way of theta to a target: 0 literal, 1 shortest, 2 always positive, 3 always negative. */
  turning = 0;
  /** Seconds in a tick. */
  period = 5e-5;
  geometry = { radius: 100, start: 20, end: 180, disk: 80 };
  /** The last of `MON?`: base frame. */
  now = null;
  /** Whether the pivots stand still, as measured. */
  resting = false;
  #before = null;
  /** Answers to questions that not every controller knows, by question. */
  replies = {};

  constructor(link) {
    super();
    this.link = link;
    link.addEventListener("hello", ({ detail }) => this.#hello(detail));
    link.addEventListener("status", ({ detail }) => this.#status(detail.replies));
    setInterval(() => {
      if (this.connected && !link.freshness.stale && !document.hidden) this.#lookAtGeometry();
    }, GEOMETRY_EVERY_MS);
  }

  /** Whether the controller knows this command. */
  knows(word) {
    return this.known.has(word);
  }

  async #hello(hello) {
    Object.assign(this, { connected: hello.connected, reason: hello.reason, place: hello.place, identity: hello.identity });
    this.simulated = SIMULATED.test(hello.identity.split(",")[2]?.trim());
    this.help = hello.help.split("\n").slice(1, -1);
    this.known = commands(hello.help);
    this.now = null;
    this.resting = false;
    this.#before = null;
    if (!hello.connected) {
      this.#tell("link");
      return;
    }
    await this.#lookAtGeometry();
    this.#tell("link");
  }

  async #lookAtGeometry() {
    try {
      await this.#askGeometry();
    } catch {
      // Asked again soon.
    }
  }

  async #askGeometry() {
    const ids = [PERIOD, RADIUS, GUIDE_START, GUIDE_LENGTH, SPEED, TURN_DIRECTION];
    const reply = fields(await this.link.urge(`SPA? ${ids.map((id) => `1 ${id}`).join(" ")}`));
    const value = (id) => Number(reply[`1 ${id}`]);
    const disk = Number(fields(await this.link.urge("TMX? X")).X);
    this.period = value(PERIOD);
    this.fastest = value(SPEED);
    this.turning = value(TURN_DIRECTION);
    const radius = value(RADIUS);
    const start = value(GUIDE_START) * radius;
    this.geometry = { radius, start, end: start + value(GUIDE_LENGTH) * radius, disk };
  }

  #status(replies) {
    if (!this.connected) return;
    Object.assign(this.replies, replies);
    if (replies["MON?"]) this.#monitor(fields(replies["MON?"]));
    if (replies["POS? X Y W"]) this.#slow(replies);
  }

  #monitor(mon) {
    const all = (name) => [1, 2, 3].map((number) => numbers(mon[`${name}${number}`]));
    this.mode = mon.MODE;
    this.now = {
      time: Number(mon.TICK) * this.period,
      centre: [Number(mon.X), Number(mon.Y)],
      deg: Number(mon.W),
      pivots: all("PIVOT").map(([deg]) => deg),
      errors: all("ERROR"),
      duties: all("DUTY"),
    };
    this.seen = true;
    this.#watchRest();
    this.#tell("tick");
  }

  #watchRest() {
    const { time, pivots } = this.now;
    this.#before ??= this.now;
    const passed = time - this.#before.time;
    if (passed < REST_S && passed >= 0) return;
    this.resting = passed > 0 && pivots.every((deg, i) => Math.abs(deg - this.#before.pivots[i]) < REST_DEG_S * passed);
    this.#before = this.now;
  }

  #slow(replies) {
    const triple = (question) => {
      const { X, Y, W } = fields(replies[question]);
      return [X, Y, W].map(Number);
    };
    this.measured = triple("POS? X Y W");
    this.target = triple("MOV? X Y W");
    this.settled = fields(replies["ONT? X"]).X === "1";
    this.servo = fields(replies["SVO? X"]).X === "1";
    this.referenced = fields(replies["FRF? X"]).X === "1";
    this.velocity = Number(replies["VLS?"]);
    const [fault = "", ...notices] = (replies["FLT?"] ?? "").split("\n").map((line) => line.trim());
    this.notices = notices.filter(Boolean);
    this.fault = fault.startsWith("0 ") ? "" : fault;
    const commissioned = replies["CMS?"] ?? "";
    this.notCommissioned = commissioned.startsWith("0 ") ? commissioned.slice(2) : "";
    this.#tell("slow");
  }

  #tell(kind) {
    this.dispatchEvent(new Event(kind));
  }
}
