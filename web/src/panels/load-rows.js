// Rows of the bridles: as the twin answers, as simulated, as measured.

import { knownLoad } from "../known-load.js";
import { lineIn } from "../lines.js";
import { rank, waits } from "./ranks.js";

/**
 * One row per bridle, in kN and as shares of its capacity; null what is not known. `colours`
 * are those of the bridles in the scene.
 */
export function loadRows(topology, state, colours = []) {
  const shackles = new Map(topology.shackles.map(({ name, bridle }) => [bridle, name]));
  const ranks = alarmed(state.alarms ?? []);
  const inWaves = new Map((state.lines ?? []).map((line) => [line.name, line]));
  return state.bridles.map((bridle, k) => {
    const capacity = topology.bridle_capacity_kn[k];
    const share = (kn) => (Number.isFinite(kn) ? kn / capacity : null);
    const measured = bridle.measured_kn ?? null;
    const top = knownLoad(bridle, state);
    const interval = intervalOf(bridle);
    return {
      name: bridle.name, level: bridle.level, shackle: shackles.get(k) ?? null, capacity,
      kn: bridle.tension_kn.mean, interval, lowKn: bridle.low_fidelity_kn, measuredKn: measured,
      mean: bridle.utilisation, lower: share(interval?.lower), upper: share(interval?.upper),
      low: share(bridle.low_fidelity_kn), measured: share(measured),
      ...extreme(inWaves.get(bridle.name), share), // expected in three hours of this sea
      topKn: top?.kn ?? null, top: top?.share ?? null,
      within: bridle.in_domain ?? true, reason: bridle.interval_reason ?? "", colour: colours[k],
      // An alarm of the shackle, such as its silence, is none of the bridle.
      rank: ranks.get(bridle.name) ?? null,
    };
  });
}

/** The largest tension expected of a line, and its interval where one is known, on a scale. */
const extreme = (line, scale) => {
  const { mean = null, lower = null, upper = null } = line?.maximum_3h_kn ?? {};
  return { maximumKn: mean, maximum: scale(mean), maximumLower: scale(lower), maximumUpper: scale(upper) };
};

/**
 * Rows of the other lines of a kind, for the rose: without a capacity of each their lengths are
 * hundredths of the unit that forces are shown in, `scale` of a force in kN.
 */
export function otherRows(names, state, scale, colour) {
  const ranks = alarmed(state.alarms ?? []);
  return names.map((name) => {
    const line = lineIn(state, name);
    return { name, kn: line?.mean_kn ?? null, mean: scale(line?.mean_kn), share: false, colour,
      level: line?.level, rank: ranks.get(name) ?? null, ...extreme(line, scale) };
  });
}

/** Interval of the load of a bridle; null where none is known, as where too few shackles trained. */
export const intervalOf = (bridle) =>
  (Number.isFinite(bridle?.tension_kn.lower) ? bridle.tension_kn : null);

/** The largest share that is to be seen. */
export function largest(rows) {
  return Math.max(0, ...rows.flatMap(({ mean, upper, measured, maximum, maximumUpper }) =>
    [mean, upper, measured, maximum, maximumUpper].map((share) => share ?? 0)));
}

/** By what an alarm is about, the rank of the worst that waits there. */
export function alarmed(alarms) {
  const found = new Map();
  for (const alarm of [...alarms].filter(waits).sort((a, b) => a.severity - b.severity)) {
    found.set(sourceOf(alarm.id), rank(alarm.severity));
  }
  return found;
}

/** What an alarm is about: `load.bridle-3` is about `bridle-3`. */
export const sourceOf = (id) => id.slice(id.indexOf(".") + 1);
