// Reading answers of the General Command Set.

/** Lines of a reply `name=value`, by name. */
export function fields(reply) {
  const found = {};
  for (const line of (reply ?? "").split("\n")) {
    const at = line.indexOf("=");
    if (at > 0) found[line.slice(0, at).trim()] = line.slice(at + 1).trim();
  }
  return found;
}

/** The numbers in a field, separated by spaces. */
export function numbers(field) {
  return (field ?? "").split(/\s+/).filter(Boolean).map(Number);
}

/** What a person typed as a number: a comma will do for a point. NaN when it is none. */
export function typed(text) {
  const trimmed = text.trim().replace(",", ".").replace("−", "-");
  return trimmed === "" ? NaN : Number(trimmed);
}

/** A number as the controller reads it. */
export function plain(value) {
  return String(Number(value.toFixed(9)));
}

/** Fixed decimals with a true minus, never a zero with a sign. */
export function shown(value, decimals) {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(decimals);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text.replace("-", "−");
}

/** The commands that `HLP?` lists. */
export function commands(help) {
  return new Set(help.split("\n").slice(1, -1).map((line) => line.split(" ")[0]));
}
