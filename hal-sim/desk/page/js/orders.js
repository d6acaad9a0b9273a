// Orders of one kind to the server, and what came of the last: a commissioning's or a calibration's.

import { report, setText } from "./dom.js";

export class Orders {
  #status = null;

  constructor(kind, operator, firstMove, said) {
    Object.assign(this, { kind, operator, firstMove, said });
  }

  /** Gives what `order` makes; whoever looks is asked before the first that moves. */
  async give(order, moves) {
    const taken = await report(this.said, async () => {
      const wanted = order();
      if (moves) await this.firstMove.agree();
      await this.operator.order({ [this.kind]: wanted });
    });
    if (taken) this.say(this.#status);
  }

  say(status) {
    this.#status = status;
    if (!status?.what) return;
    this.said.className = `said ${status.good ? "good" : "bad"}`;
    setText(this.said, status.runs ? `${status.what}…` : `${status.what}: ${status.said}`);
  }
}
