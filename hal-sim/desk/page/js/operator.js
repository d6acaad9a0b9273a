// The second connection to the server: sequences and the log. The server takes a page whose connection ends for gone.

import { socketTo } from "./link.js";

const RETRY_MS = 300;
/** Longest wait for the connection. */
const PATIENCE_MS = 2000;

export class Operator extends EventTarget {
  #socket = null;

  constructor(link) {
    super();
    this.link = link;
    setInterval(() => this.#open(), RETRY_MS);
    link.addEventListener("hello", () => this.#open());
  }

  get open() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /** Gives an order to the sequence; throws when it cannot get there. */
  async order(order) {
    const { stale, age } = this.link.freshness;
    const begins = order !== "stop" && order !== "pause";
    if (stale && begins && this.link.open) throw new Error(`not sent: no status for ${age.toFixed(1)} s`);
    if (!this.open) await this.#opened();
    this.#socket.send(JSON.stringify({ token: this.link.token, order }));
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
