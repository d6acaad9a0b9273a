// Before a page moves a machine that is no simulated one for the first time, it asks.

import { byId, setText } from "./dom.js";

// What a variable stands for is not known here.
const MOVES = /^\s*(MOV|MVR|MRT|MRW|STE|JOG|RCV\s+1|WGO|MAC\s+N?START)\b|\$/i;

export class FirstMove {
  /** The machine that may be moved from here, by who and where it is. */
  #agreed = "";

  constructor(stage) {
    this.stage = stage;
    this.dialog = byId("first-move");
    // A stop is an answer too.
    stage.link.addEventListener("stopping", () => this.dialog.close("no"));
    stage.link.gate = async (line) => { if (MOVES.test(line)) await this.agree(/^\s*(JOG|RCV)/i.test(line)); };
  }

  /** Throws unless it may be moved. What has to be held down cannot be taken as meant once a question was in between. */
  async agree(isHeld = false) {
    const { simulated, identity, place } = this.stage;
    const machine = `${identity} at ${place}`;
    if (simulated || this.#agreed === machine) return;
    setText(byId("first-move-machine"), machine);
    if (this.dialog.open) throw new Error("not moved: the question is still open");
    this.dialog.returnValue = "";
    // Not as a modal dialog: STOP has to work meanwhile.
    const main = document.querySelector("main");
    main.inert = true;
    this.dialog.show();
    await new Promise((resolve) => { this.dialog.addEventListener("close", resolve, { once: true }); });
    main.inert = false;
    if (this.dialog.returnValue !== "move") throw new Error("not moved: not confirmed");
    this.#agreed = machine;
    if (isHeld) throw new Error("confirmed: press again");
  }
}
