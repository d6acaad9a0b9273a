// The connection to the server: status in, command lines out. Comes back by itself when the server does.

import { GcsError } from "./errors.js";

const RETRY_MS = 700;

export class Link extends EventTarget {
  #socket = null;
  #token = "";
  #next = 1;
  #waiting = new Map();

  constructor() {
    super();
    this.#open();
  }

  /** Sends a line; its reply, or null for a line without one. Rejects with a GcsError, or an Error when it did not get there. */
  ask(line) {
    return new Promise((resolve, reject) => {
      if (this.#socket?.readyState !== WebSocket.OPEN) {
        reject(new Error("not connected"));
        return;
      }
      const id = this.#next++;
      this.#waiting.set(id, { line, resolve, reject });
      this.#socket.send(JSON.stringify({ id, token: this.#token, line }));
    });
  }

  async #open() {
    try {
      // Another one after every restart of the server.
      const response = await fetch("/token");
      if (!response.ok) throw new Error();
      this.#token = await response.text();
    } catch {
      this.#lost();
      return;
    }
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    this.#socket = socket;
    socket.onmessage = (event) => this.#take(JSON.parse(event.data));
    socket.onclose = () => this.#lost();
  }

  #lost() {
    for (const { reject } of this.#waiting.values()) reject(new Error("the connection broke"));
    this.#waiting.clear();
    const reason = "The server of this page does not answer. Trying again…";
    this.#tell("hello", { connected: false, place: "", identity: "", help: "", reason });
    setTimeout(() => this.#open(), RETRY_MS);
  }

  #take(message) {
    const request = this.#waiting.get(message.id);
    this.#waiting.delete(message.id);
    if (message.kind === "answer") {
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
