// The second connection to the server: sequences, commissioning, calibration and the log. The server takes a page whose connection ends for gone.

import { socketTo } from "./link.js";

/** What orders are for, besides sequences. */
const RUNS = ["commissioning", "calibration"];
const RETRY_MS = 300;
/** Longest wait for the connection, and for an answer. */
const PATIENCE_MS = 2000;

export class Operator extends EventTarget {
  #socket = null;
  /** What orders are known for this page's by. */
  #key = "";

  constructor(link) {
    super();
    this.link = link;
    link.addEventListener("you", ({ detail }) => { this.#key = detail.key; });
    setInterval(() => this.#open(), RETRY_MS);
    link.addEventListener("hello", () => this.#open());
  }

  get open() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /** Gives an order to the sequence, the commissioning or the calibration; throws when it cannot get there, or nobody answers. */
  async order(order) {
    const { stale, age } = this.link.freshness;
    const run = RUNS.find((kind) => order[kind]);
    const begins = !["stop", "pause", "end"].includes(run ? order[run] : order);
    if (stale && begins && this.link.open) throw new Error(`not sent: no status for ${age.toFixed(1)} s`);
    if (!this.open) await this.#opened();
    const told = this.#told(run ?? "sequence");
    this.#socket.send(JSON.stringify({ token: this.link.token, order, who: this.link.who, key: this.#key }));
    await told;
  }

  /** Every order changes what is told of what it is for. */
  #told(kind) {
    return new Promise((resolve, reject) => {
      const silence = setTimeout(() => reject(new Error("no answer: whether it was carried out is not known")), PATIENCE_MS);
      const done = () => {
        clearTimeout(silence);
        resolve();
      };
      this.addEventListener(kind, done, { once: true });
    });
  }

  #opened() {
    return new Promise((resolve, reject) => {
      this.addEventListener("opened", resolve, { once: true });
      setTimeout(() => reject(new Error("not sent: not connected")), PATIENCE_MS);
    });
  }

  #open() {
    if (!this.link.open || (this.#socket && this.#socket.readyState !== WebSocket.CLOSED)) return;
    this.#socket = socketTo("/operator");
    this.#socket.onopen = () => this.dispatchEvent(new Event("opened"));
    this.#socket.onmessage = ({ data }) => {
      const message = JSON.parse(data);
      this.dispatchEvent(new CustomEvent(message.kind, { detail: message }));
    };
  }
}
