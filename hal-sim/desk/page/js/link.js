// The connection to the server: status in, command lines out. Comes back by itself when the server does.

import { GcsError } from "./errors.js";
import { Freshness } from "./freshness.js";

const RETRY_MS = 700;
/** Longest wait for an answer. */
const PATIENCE_MS = 2000;
const UNKNOWN = "whether it was carried out is not known";

/** A WebSocket of this server. */
export function socketTo(path) {
  return new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`);
}

export class Link extends EventTarget {
  freshness = new Freshness();
  /** Asked before a line goes out; throws if it is not to go. */
  gate = async () => {};
  /** Name of whoever uses this page, for the log. */
  who = "";
  #socket = null;
  #token = "";
  #next = 1;
  #waiting = new Map();

  constructor() {
    super();
    this.addEventListener("status", ({ detail }) => this.freshness.take(detail.replies["MON?"] ?? ""));
    this.#open();
  }

  /** Whether the server can be reached at all. */
  get open() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /** What every request brings along. */
  get token() {
    return this.#token;
  }

  /**
   * Sends a line; its reply, or null for a line without one. Rejects with a GcsError, or with an Error when it did not get there
   * or was not answered in time. Nothing is sent while the status is stale: it would act on a stage that nobody sees.
   */
  async ask(line) {
    await this.freshness.begun();
    const { stale, age } = this.freshness;
    if (this.open && stale) throw new Error(`not sent: no status for ${age.toFixed(1)} s`);
    await this.gate(line);
    if (!line.includes("?")) this.dispatchEvent(new CustomEvent("asked", { detail: line }));
    return this.urge(line);
  }

  /** The same, whatever the status: for a stop, and for finding out what became of it. */
  urge(line) {
    return new Promise((resolve, reject) => {
      if (!this.open) {
        reject(new Error("not sent: not connected"));
        return;
      }
      const id = this.#next++;
      const late = () => this.#settle(id)?.reject(new Error(`no answer within ${PATIENCE_MS / 1000} s: ${UNKNOWN}`));
      this.#waiting.set(id, { line, resolve, reject, timer: setTimeout(late, PATIENCE_MS) });
      this.#socket.send(JSON.stringify({ id, token: this.#token, line, who: this.who }));
    });
  }

  async #open() {
    try {
      // Another one after every restart of the server.
      const response = await fetch("/token", { signal: AbortSignal.timeout(PATIENCE_MS) });
      if (!response.ok) throw new Error();
      this.#token = await response.text();
    } catch {
      this.#lost();
      return;
    }
    const socket = socketTo("/live");
    this.#socket = socket;
    this.freshness.begins();
    socket.onmessage = (event) => this.#take(JSON.parse(event.data));
    socket.onclose = () => this.#lost();
  }

  #lost() {
    for (const id of [...this.#waiting.keys()]) this.#settle(id).reject(new Error(`the connection broke: ${UNKNOWN}`));
    this.freshness.lost();
    const reason = "The server of this page does not answer. Trying again…";
    this.#tell("hello", { connected: false, place: "", identity: "", help: "", reason });
    setTimeout(() => this.#open(), RETRY_MS);
  }

  /** Who waits for this answer, and no longer does. */
  #settle(id) {
    const request = this.#waiting.get(id);
    clearTimeout(request?.timer);
    this.#waiting.delete(id);
    return request;
  }

  #take(message) {
    const request = this.#settle(message.id);
    if (message.kind === "answer") {
      if (message.error) this.#tell("error", message.error);
      if (message.error) request?.reject(new GcsError(message.error, request.line));
      else request?.resolve(message.reply);
    } else if (message.kind === "refused") {
      request?.reject(new Error(message.reason));
    } else {
      this.#tell(message.kind, message);
    }
  }

  #tell(kind, detail) {
    this.dispatchEvent(new CustomEvent(kind, { detail }));
  }
}
