// Reading the recorder's answers: what there is to record, and what was recorded.

/** Sections of `HDR?` by name, each its entries by number. */
export function sections(reply) {
  const found = {};
  let section = {};
  for (const line of reply.split("\n")) {
    if (line.startsWith("#")) section = found[line.slice(1).trim()] = {};
    const at = line.indexOf("=");
    if (at > 0) section[line.slice(0, at).trim()] = line.slice(at + 1).trim();
  }
  return found;
}

/** An answer of `DRR?`: names and values of its columns, and the time from row to row, s. */
export function table(reply) {
  const lines = reply.split("\n");
  const end = lines.findIndex((line) => line.startsWith("# END_HEADER"));
  const head = {};
  for (const line of lines.slice(0, end)) {
    const at = line.indexOf("=");
    if (at > 0) head[line.slice(1, at).trim()] = line.slice(at + 1).trim();
  }
  const rows = lines.slice(end + 1).map((line) => line.trim().split(/\s+/).map(Number));
  const count = Number(head.DIM);
  return {
    names: Array.from({ length: count }, (_, i) => head[`NAME${i}`] ?? `column ${i + 1}`),
    values: Array.from({ length: count }, (_, i) => rows.map((row) => row[i])),
    period: Number(head.SAMPLE_TIME),
  };
}
