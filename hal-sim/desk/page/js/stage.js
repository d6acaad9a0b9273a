// What is known of the stage, from the status messages. Everybody else in the page reads it here.

import { commands, fields, numbers } from "./gcs.js";

const PERIOD = "0xE000200";
const RADIUS = "0x54500200";
const GUIDE_START = "0x54500201";
const GUIDE_LENGTH = "0x54500202";

export class Stage extends EventTarget {
  connected = false;
  reason = "";
  place = "";
  identity = "";
  /** Commands that the controller knows. */
  known = new Set();
  /** "off", "holding", "moving", "stopping" at a fault, or "fault". */
  mode = "off";
  fault = "";
  referenced = false;
  servo = false;
  settled = false;
  /** Coordinates of the frame in force, mm and deg; null while unknown. */
  measured = null;
  target = null;
  velocity = NaN;
  /** Seconds in a tick. */
  period = 5e-5;
  geometry = { radius: 100, start: 20, end: 180, disk: 80 };
  /** The last of `MON?`: base frame. */
  now = null;
  /** Answers to questions that not every controller knows, by question. */
  replies = {};

  constructor(link) {
    super();
    this.link = link;
    link.addEventListener("hello", ({ detail }) => this.#hello(detail));
    link.addEventListener("status", ({ detail }) => this.#status(detail.replies));
  }

  /** Whether the controller knows this command. */
  knows(word) {
    return this.known.has(word);
  }

  async #hello(hello) {
    Object.assign(this, { connected: hello.connected, reason: hello.reason, place: hello.place, identity: hello.identity });
    this.known = commands(hello.help);
    this.now = null;
    if (!hello.connected) {
      this.#tell("link");
      return;
    }
    try {
      await this.#askGeometry();
    } catch {
      // The connection broke again: the next hello asks anew.
    }
    this.#tell("link");
  }

  async #askGeometry() {
    const ids = [PERIOD, RADIUS, GUIDE_START, GUIDE_LENGTH];
    const reply = fields(await this.link.ask(`SPA? ${ids.map((id) => `1 ${id}`).join(" ")}`));
    const value = (id) => Number(reply[`1 ${id}`]);
    const disk = Number(fields(await this.link.ask("TMX? X")).X);
    this.period = value(PERIOD);
    const radius = value(RADIUS);
    const start = value(GUIDE_START) * radius;
    this.geometry = { radius, start, end: start + value(GUIDE_LENGTH) * radius, disk };
    this.#tell("geometry");
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
    this.#tell("tick");
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
    const fault = replies["FLT?"] ?? "";
    this.fault = fault.startsWith("0 ") ? "" : fault;
    this.#tell("slow");
  }

  #tell(kind) {
    this.dispatchEvent(new Event(kind));
  }
}
