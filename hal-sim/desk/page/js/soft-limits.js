// Soft limits of x and y, for the drawing: asked for when they may have changed.

import { fields } from "./gcs.js";

/** They change by a command of somebody, seldom. */
const EVERY_MS = 3000;

export class SoftLimits {
  /** Lowest and highest x and y in the base frame, mm, where they count; else null. */
  x = null;
  y = null;

  constructor(stage) {
    this.stage = stage;
    const known = () => ["SSL?", "NLM?", "PLM?"].every((word) => stage.knows(word));
    const look = () => { if (stage.connected && !stage.link.freshness.stale && !document.hidden && known()) this.#ask(); };
    stage.addEventListener("link", look);
    setInterval(look, EVERY_MS);
  }

  async #ask() {
    try {
      const [counts, low, high] = await Promise.all(["SSL?", "NLM?", "PLM?"].map((word) => this.stage.link.ask(`${word} X Y`).then(fields)));
      for (const [name, axis] of [["x", "X"], ["y", "Y"]]) this[name] = counts[axis] === "1" ? [Number(low[axis]), Number(high[axis])] : null;
    } catch {
      // Asked again soon.
    }
  }

  /** Whether any of them leaves out a part of the usable disk. */
  get matter() {
    const { disk } = this.stage.geometry;
    return [this.x, this.y].some((range) => range && (range[0] > -disk || range[1] < disk));
  }
}
