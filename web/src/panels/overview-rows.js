// What the slider through time has behind it: the largest load, and where alarms were raised.

import { rank } from "./ranks.js";

const TIMEOUT_S = 900; // of a shackle, so long its reading counts

/** The readings of a shackle in force at each time; null where there is none. */
function heldAt(times, { t, value }) {
  let k = -1;
  return times.map((now) => {
    while (k + 1 < t.length && t[k + 1] <= now) k += 1;
    return k >= 0 && now - t[k] <= TIMEOUT_S ? value[k] : null;
  });
}

/**
 * The largest share of capacity over all bridles at each time, predicted or measured; null where
 * a bridle is not known.
 */
export function largestOver(columns, capacities, shackles = []) {
  const all = Object.values(columns.bridles).map(({ mean }, k) => [mean, capacities[k]]);
  const measured = shackles.filter(({ name }) => columns.measured?.[name]).map(({ name, bridle }) =>
    [heldAt(columns.t, columns.measured[name]), capacities[bridle]]);
  return columns.t.map((_, at) => {
    const shares = all.map(([mean, kn]) => (mean[at] === null ? null : mean[at] / kn));
    if (shares.includes(null) || !shares.length) return null;
    return Math.max(...shares, ...measured.map(([value, kn]) => (value[at] ?? 0) / kn));
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
