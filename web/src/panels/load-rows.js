// What is said of each bridle: as the twin answers, as simulated, as measured.

import { rank, waits } from "./ranks.js";

/**
 * One row per bridle, in kN and as shares of its capacity; null what is not known. `colours`
 * are those of the bridles in the scene.
 */
export function loadRows(topology, state, colours = []) {
  const read = new Map(state.sensors.map((sensor) => [sensor.name, sensor.measured]));
  const shackles = new Map(topology.shackles.map(({ name, bridle }) => [bridle, name]));
  const ranks = alarmed(state.alarms ?? []);
  return state.bridles.map((bridle, k) => {
    const capacity = topology.bridle_capacity_kn[k];
    const share = (kn) => (Number.isFinite(kn) ? kn / capacity : null);
    const measured = read.get(shackles.get(k)) ?? null;
    const interval = intervalOf(bridle);
    return {
      name: bridle.name, level: bridle.level, shackle: shackles.get(k) ?? null, capacity,
      kn: bridle.tension_kn.mean, interval, lowKn: bridle.low_fidelity_kn, measuredKn: measured,
      mean: bridle.utilisation, lower: share(interval?.lower), upper: share(interval?.upper),
      low: share(bridle.low_fidelity_kn), measured: share(measured),
      colour: colours[k], rank: ranks.get(bridle.name) ?? ranks.get(shackles.get(k)) ?? null,
    };
  });
}

/**
 * Where the load of a bridle lies; null where no shackle has taught it. The simulation alone
 * knows how well it is followed, not how far it is off at sea.
 */
export const intervalOf = (bridle) => (bridle?.level > 1 ? bridle.tension_kn : null);

/** The largest share that is to be seen. */
export function largest(rows) {
  return Math.max(0, ...rows.flatMap(({ mean, upper, measured }) => [mean ?? 0, upper ?? 0, measured ?? 0]));
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
