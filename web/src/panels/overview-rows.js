// What the slider through time has behind it: the largest load, and where alarms were raised.

import { rank } from "./ranks.js";

/** The largest share of capacity over all bridles at each time; null where nothing is known. */
export function largestOver(columns, capacities) {
  const all = Object.values(columns.bridles).map(({ mean }, k) => [mean, capacities[k]]);
  return columns.t.map((_, at) => {
    const shares = all.map(([mean, kn]) => (mean[at] === null ? null : mean[at] / kn));
    return shares.includes(null) || !shares.length ? null : Math.max(...shares);
  });
}

/** Alarms that were raised, with their rank as far as it is still known; the worst last, on top. */
export function marksOf(lines, alarms) {
  const severities = new Map((alarms ?? []).map(({ id, severity }) => [id, severity]));
  return lines.filter(({ action }) => action === "raised")
    .map(({ alarm, t }) => ({ t: Date.parse(t), severity: severities.get(alarm) ?? 1 }))
    .sort((a, b) => a.severity - b.severity)
    .map(({ t, severity }) => ({ t, rank: rank(severity) }));
}

/** Stretches without a gap of knowledge longer than `gap` seconds. */
export function runs(times, shares, gap) {
  const found = [];
  let last = -Infinity;
  times.forEach((t, k) => {
    if (shares[k] === null) last = -Infinity;
    else {
      if (t - last > gap) found.push([]);
      found.at(-1).push([t, shares[k]]);
      last = t;
    }
  });
  return found;
}
