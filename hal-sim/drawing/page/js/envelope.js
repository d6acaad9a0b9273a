// Lowest and highest of several quantities in stretches of time, kept for a while: decimation that hides nothing.

export class Envelope {
  /** Channels, and how long they are kept, s. */
  constructor(channels, keptS) {
    this.keptS = keptS;
    this.times = [];
    this.low = Array.from({ length: channels }, () => []);
    this.high = Array.from({ length: channels }, () => []);
  }

  /** The lowest and highest of every channel since the stretch before. */
  add(time, low, high) {
    const last = this.times.at(-1);
    // The controller has begun to count anew.
    if (last !== undefined && time < last) this.clear();
    this.times.push(time);
    this.low.forEach((values, i) => values.push(low[i]));
    this.high.forEach((values, i) => values.push(high[i]));
    if (this.times[0] < time - 1.25 * this.keptS) this.#forget(time - this.keptS);
  }

  /** Nothing is known between the last stretch and the next one. */
  gap() {
    const last = this.times.at(-1);
    if (last !== undefined) this.add(last, this.low.map(() => NaN), this.high.map(() => NaN));
  }

  clear() {
    this.times.length = 0;
    for (const values of [...this.low, ...this.high]) values.length = 0;
  }

  #forget(before) {
    const count = this.times.findIndex((time) => time >= before);
    this.times.splice(0, count);
    for (const values of [...this.low, ...this.high]) values.splice(0, count);
  }
}

/**
 * The value of a channel at a time: on the line from middle to middle of the stretches, and never outside the lowest and highest
 * of the stretch that the time lies in. NaN where nothing is known.
 */
export function valueAt({ times, low, high }, channel, time) {
  if (times.length === 0) return NaN;
  const middle = (at) => ({ time: (times[Math.max(0, at - 1)] + times[at]) / 2, value: (low[channel][at] + high[channel][at]) / 2 });
  const place = Math.min(placeOf(times, time), times.length - 1);
  const here = middle(place);
  const beside = middle(Math.min(Math.max(place + (time < here.time ? -1 : 1), 0), times.length - 1));
  const gap = beside.time - here.time;
  const share = gap === 0 ? 0 : Math.min(Math.max((time - here.time) / gap, 0), 1);
  const value = here.value + share * (beside.value - here.value);
  return Math.min(Math.max(value, low[channel][place]), high[channel][place]);
}

/** The first place in sorted `times` that is not before `time`. */
export function placeOf(times, time) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] < time) low = middle + 1;
    else high = middle;
  }
  return low;
}
