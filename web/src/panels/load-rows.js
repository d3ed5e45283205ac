// Rows of the bridles: as the twin answers, as simulated, as measured.

import { knownLoad } from "../known-load.js";
import { rank, waits } from "./ranks.js";

/**
 * One row per bridle, in kN and as shares of its capacity; null what is not known. `colours`
 * are those of the bridles in the scene.
 */
export function loadRows(topology, state, colours = []) {
  const shackles = new Map(topology.shackles.map(({ name, bridle }) => [bridle, name]));
  const ranks = alarmed(state.alarms ?? []);
  const inWaves = new Map((state.lines ?? []).map(({ name, utilisation }) => [name, utilisation]));
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
      maximum: inWaves.get(bridle.name) ?? null, // expected in three hours of this sea
      topKn: top?.kn ?? null, top: top?.share ?? null,
      within: bridle.in_domain ?? true, reason: bridle.interval_reason ?? "", colour: colours[k],
      // An alarm of the shackle, such as its silence, is none of the bridle.
      rank: ranks.get(bridle.name) ?? null,
    };
  });
}

/**
 * Interval of the load of a bridle; null where none is known, as where no shackle has trained
 * level 2: the error of the simulation alone at sea is not known.
 */
export const intervalOf = (bridle) =>
  (bridle?.level > 1 && Number.isFinite(bridle.tension_kn.lower) ? bridle.tension_kn : null);

/** The largest share that is to be seen. */
export function largest(rows) {
  return Math.max(0, ...rows.flatMap(({ mean, upper, measured, maximum }) =>
    [mean, upper, measured, maximum].map((share) => share ?? 0)));
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
