// Round numbers along an axis.

/** Round values inside [low, high], about `count` of them, and the decimals they need. */
export function ticks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough * 0.7);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const values = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + step * 1e-9; n += 1) values.push(n * step);
  return { values, decimals, step };
}

/** A range that holds `low` and `high` with some room, never empty. */
export function widened(low, high) {
  if (!(low <= high)) return [-1, 1];
  const room = Math.max((high - low) * 0.08, Math.abs(high) * 1e-6, 1e-6);
  return [low - room, high + room];
}
