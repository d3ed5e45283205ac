// The stand-in service's states: what is so at a time, and what would be in a sea.

import { answersIn, seaAt, shapeIn, topologyOf } from "./cage.js";
import { encodeFrame } from "./encode.js";

const BEYOND_M_S = 0.9; // what the made-up twin has learned

/** What keeps a cage from being well, in the service's words. */
export const CONCERNS = {
  volume: { kind: "volume", title: "Volume low",
    message: "The net holds 71 % of its volume in still water; 80 % is the limit." },
  measured: { kind: "measured", title: "Nothing measured",
    message: "No sensor has given a valid reading within its timeout: all is predicted." },
  load: { kind: "load", title: "Load at its limit",
    message: "bridle-8 bears 82 % of its capacity, measured by shackle-2; 80 % is the limit." },
};

const iso = (t) => new Date(t).toISOString();

/** A cage's state as JSON. `one` says how the cage fares: {name, strength, trouble}. */
export function stateOf(one, t, sea, alarms) {
  const valid = one.trouble !== "silent";
  const { bridles, sensors } = answersIn(sea, t, one.trouble === "load");
  if (!valid) {
    for (const bridle of bridles) {
      Object.assign(bridle, { tension_kn: { mean: null, lower: null, upper: null },
        low_fidelity_kn: null, utilisation: null });
    }
    for (const sensor of sensors) {
      Object.assign(sensor, { mean: null, lower: null, upper: null, low_fidelity: null });
    }
  }
  const has = (kind) => (one.concerns ?? []).some((concern) => concern.kind === kind);
  if (has("measured")) {
    for (const sensor of sensors) Object.assign(sensor, { measured: null, measured_age_s: null });
    for (const bridle of bridles) Object.assign(bridle, { measured_kn: null, measured_utilisation: null });
  }
  if (has("load")) Object.assign(bridles[7], { measured_kn: 131, measured_utilisation: 0.82 });
  return {
    cage: one.name, t: iso(t), age_s: valid ? (t / 1e3) % 600 : 7300, valid,
    in_domain: valid && sea.current_speed_m_s < BEYOND_M_S,
    reason: valid ? "" : "buoy-1 has been silent for 2.0 h, longer than 0.5 h.",
    origin: "virtual field", water: valid ? sea : null, bridles, sensors, shape_level: 1,
    volume_fraction: !valid ? null : has("volume") ? 0.71 : 1 - 0.22 * sea.current_speed_m_s ** 2,
    lines: linesIn(bridles, sea), lines_reason: "",
    silent: valid ? [] : ["buoy-1"], amended: [], alarms, concerns: one.concerns ?? [],
    shape: { level: 1, in_domain: valid, interval_reason: one.spread ? ""
      : "No sensor has trained level 2 of the shape, so its error is not known." },
  };
}

/** Made-up loads in waves: bridles, then a few lines more. */
function linesIn(bridles, sea) {
  const dead = bridles[0].tension_kn.mean === null;
  const more = topologyOf("any", 1).lines.map(({ name }, k) => ({ name, level: 1,
    tension_kn: { mean: dead ? null : { frame: 46, anchor: 62, buoy: 9 }[name.split("-")[0]] * (1 + 0.35 * Math.sin(2 * k)) } }));
  return [...bridles, ...more].map(({ name, level, tension_kn: { mean } }, k) => {
    const std = mean === null ? null : 0.06 * mean * (sea?.hs_m ?? 0) + 0.2;
    const maximum = mean === null ? null : mean + 4.1 * std;
    const half = level > 1 && mean !== null ? 0.9 * std : null;
    const bridle = name.startsWith("bridle");
    return rounded({ name, kind: bridle ? "bridle" : `${name.split("-")[0]} line`, level, mean_kn: mean, std_kn: std,
      maximum_3h_kn: { mean: maximum, lower: half && maximum - half, upper: half && maximum + 1.3 * half },
      utilisation: bridle && mean !== null ? maximum / 160 : null,
      damage_per_year: bridle && mean !== null ? 0.021 * (maximum / 80) ** 3 : null,
      damage: bridle ? 0.0034 + 0.0004 * k : null, damage_since: "2026-01-18T00:00:00Z", damage_valid_h: 7420.5, damage_missing_h: 38.2 });
  });
}

/** As the service rounds: forces to a newton, damage finer. */
function rounded(line) {
  return JSON.parse(JSON.stringify(line, (key, value) =>
    (typeof value === "number" ? Number(value.toFixed(/damage/.test(key) ? 6 : 3)) : value)));
}

/** Made up: what would be without each line, the worst first. */
export function partedOf(one, t, sea) {
  const { lines } = stateOf(one, t, sea, []);
  const valid = one.trouble !== "silent";
  const found = !valid ? [] : lines.filter(({ kind }) => kind !== "buoy line").map(({ name, kind, mean_kn: mean, maximum_3h_kn: { mean: most } }, k) => ({
    parted: name, kind, in_domain: k % 7 !== 3, largest_mean: { line: lines[(k + 1) % 12].name, kn: 1.5 * mean + 20 },
    largest_maximum_3h: { line: lines[(k + 1) % 12].name, kn: 1.6 * most + 25 }, utilisation: (1.6 * most + 25) / 160,
    second_would_part: 1.6 * most + 25 > 160, volume_share: 0.9 - 0.001 * mean, clearance_m: 150 - 0.03 * mean, drift_m: 0.1 * mean,
  })).sort((a, b) => b.utilisation - a.utilisation);
  return { cage: one.name, time: iso(t), reason: valid ? null : "buoy-1 has been silent for 2.0 h.", lines: found };
}

/** A cage's frame; flags are added to those that follow from the state. */
export function frameOf(one, t, sea, alarms, flags = 0) {
  const state = stateOf(one, t, sea, alarms);
  const shape = state.valid ? shapeIn(sea) : {};
  if (!one.spread) shape.sigma = null;
  const all = (state.valid ? 1 : 0) | (state.in_domain ? 2 : 0) | flags;
  return encodeFrame({ t, flags: all, state, ...shape });
}

/** A cage's history between two times, in so many steps. */
export function historyOf(one, from, to, limit) {
  const count = Math.max(2, Math.min(limit, 500));
  const times = Array.from({ length: count }, (_, k) => from + ((to - from) * k) / (count - 1));
  const states = times.map((t) => stateOf(one, t, seaAt(t, one.strength), []));
  const of = (list, key, pick) => Object.fromEntries(states[0][list].map(({ name, unit, level }, k) =>
    [name, { unit: unit ?? "kN", level, ...Object.fromEntries(Object.entries(pick).map(
      ([to_, read]) => [to_, states.map((state) => read(state[list][k]))])) }]));
  return {
    t: times.map(iso), valid: states.map(({ valid }) => valid),
    in_domain: states.map(({ in_domain }) => in_domain),
    current_speed_m_s: states.map(({ water }) => water?.current_speed_m_s ?? null),
    current_to_deg: states.map(({ water }) => water?.current_to_deg ?? null),
    bridles: of("bridles", "name", {
      low_fidelity: (b) => b.low_fidelity_kn, mean: (b) => b.tension_kn.mean,
      lower: (b) => b.tension_kn.lower, upper: (b) => b.tension_kn.upper,
    }),
    sensors: of("sensors", "name", {
      low_fidelity: (s) => s.low_fidelity, mean: (s) => s.mean,
      lower: (s) => s.lower, upper: (s) => s.upper,
    }),
    measured: Object.fromEntries(states[0].sensors.map(({ name }, k) =>
      [name, { t: times.map(iso), value: states.map(({ sensors }) => sensors[k].measured) }])),
    volume_fraction: states.map(({ volume_fraction }) => volume_fraction),
  };
}
