// Numbers as people read them. What nobody measured is empty.

const known = (value, spell) => (value === null || value === undefined ? "" : spell(value));

export const often = (value) => known(value, (n) => (n >= 100 ? n.toFixed(0) : n.toFixed(1)));
export const count = (value) => known(value, (n) => n.toLocaleString("en"));
export const ms = (value) => known(value, (n) => (n * 1000 < 10 ? `${(n * 1000).toFixed(2)} ms` : `${(n * 1000).toFixed(0)} ms`));

export const bytes = (value) =>
  known(value, (n) => {
    if (n < 1000) return `${n.toFixed(0)} B`;
    if (n < 1e6) return `${(n / 1e3).toFixed(1)} kB`;
    return n < 1e9 ? `${(n / 1e6).toFixed(1)} MB` : `${(n / 1e9).toFixed(1)} GB`;
  });

// A carrier without what is attached to it.
export const short = (carrier) => carrier.split("+")[0];

// For sorting: what is unknown comes last.
export function order(a, b, down) {
  const none = (value) => value === null || value === undefined || value === "";
  if (none(a) || none(b)) return none(a) - none(b);
  const found = typeof a === "number" ? a - b : String(a).localeCompare(String(b), "en", {numeric: true});
  return down ? -found : found;
}
