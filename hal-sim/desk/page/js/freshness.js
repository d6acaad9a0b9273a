// Whether what the page shows is of now. A status is new only if the controller's tick has gone on: one whose control loop
// hangs may still answer.

/** Longest time between two new statuses, ms. */
const LONGEST_MS = 500;
const LOOK_MS = 100;

export class Freshness extends EventTarget {
  /** No new status for too long, or none yet. */
  stale = true;
  #tick = "";
  #since = performance.now();
  #looked = performance.now();
  #wasBusy = false;
  #beginning = -Infinity;

  constructor() {
    super();
    setInterval(() => this.#look(), LOOK_MS);
  }

  /** How long ago the last new status came, s. */
  get age() {
    return (performance.now() - this.#since) / 1000;
  }

  /** Takes the answer to `MON?`. */
  take(monitor) {
    const tick = /^TICK=(\d+)/m.exec(monitor)?.[1] ?? this.#tick;
    if (tick === this.#tick) return;
    this.#tick = tick;
    this.#since = performance.now();
    this.#tell(false);
  }

  /** A connection begins: its first status is waited for. */
  begins() {
    this.#beginning = performance.now();
  }

  /** Until there is a status, or no longer than one may take on a new connection. */
  async begun() {
    const left = LONGEST_MS - (performance.now() - this.#beginning);
    if (!this.stale || left < 0) return;
    await new Promise((resolve) => {
      this.addEventListener("change", resolve, { once: true });
      setTimeout(resolve, left);
    });
  }

  /** There is nobody at the other end. */
  lost() {
    this.#tell(true);
  }

  #look() {
    const now = performance.now();
    // After a long pause of the page itself, what came meanwhile is taken first. One that is never quicker looks all the same.
    const busy = now - this.#looked > 3 * LOOK_MS && !this.#wasBusy;
    this.#looked = now;
    this.#wasBusy = busy;
    if (!busy && now - this.#since > LONGEST_MS) this.#tell(true);
  }

  #tell(stale) {
    if (!stale && !this.stale) return;
    this.stale = stale;
    this.dispatchEvent(new Event("change"));
  }
}
