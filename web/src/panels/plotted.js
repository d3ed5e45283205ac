// What a chart draws of one quantity: rows over one set of times, with gaps where nothing is known.

import { text } from "../texts/index.js";
import { plain, titled, withUnit } from "./format.js";

/** The quantities that can be charted: {key, name, title, kind, unit, place, sensor}. */
export function quantities(topology) {
  const shackles = new Map(topology.shackles.map(({ name, bridle }) => [bridle, name]));
  const rest = (node) => -topology.rest_position_m[node][2];
  return [
    ...topology.depth_sensors.map(({ name, node }) => ({
      key: `sensor:${name}`, name, kind: "depths", unit: "m", downwards: true, sensor: name,
      place: text("charts.rests", { depth: withUnit(rest(node), "m") }),
    })),
    ...topology.shackles.map(({ name, bridle }) => ({
      key: `sensor:${name}`, name, kind: "shackles", unit: "kN", downwards: false, sensor: name,
      place: text("charts.on", { bridle: plain(topology.bridle_names[bridle]) }),
    })),
    ...topology.bridle_names.map((name, k) => ({
      key: `bridle:${name}`, name, kind: "bridles", unit: "kN", downwards: false,
      sensor: shackles.get(k) ?? null,
      place: text("charts.capacity", { capacity: withUnit(topology.bridle_capacity_kn[k], "kN", 0) }),
    })),
    { key: "water:speed", name: text("charts.current"), kind: "water", unit: "m/s", downwards: false,
      sensor: null, place: text("charts.answer") },
    { key: "cage:volume", name: text("charts.volume"), kind: "water", unit: "%", downwards: false,
      sensor: null, place: text("now.ofStill") },
  ].map((one) => ({ ...one, title: titled(one.name) }));
}

/**
 * Rows of one quantity: {t, lower, upper, low, mean} and {t, value} of what was measured.
 */
export function rowsOf(columns, { key, name, sensor }) {
  const nothing = columns.t.map(() => null);
  const alone = (mean) => ({ lower: nothing, upper: nothing, low: nothing, mean });
  const series = key === "water:speed" ? alone(columns.speed)
    : key === "cage:volume" ? alone(columns.volume.map((share) => (share === null ? null : 100 * share)))
    : columns[key.startsWith("bridle:") ? "bridles" : "sensors"][name] ?? alone(nothing);
  const measured = columns.measured[sensor] ?? { t: [], value: [] };
  return { t: columns.t, ...series, measured };
}

/**
 * Put the twin's rows and the readings over one set of times.
 *
 * Columns: t, lower, upper, measured, low, mean, as they are drawn one over the other. A row of nulls breaks the
 * curves where the twin gave no answer for longer than `gap` seconds; undefined, where only the
 * other has a value, does not.
 */
export function joined(rows, gap) {
  const names = ["lower", "upper", "low", "mean"];
  const table = { t: [], lower: [], upper: [], low: [], mean: [], measured: [] };
  const put = (t, values, measured) => {
    table.t.push(t);
    names.forEach((name) => table[name].push(values ? values[name] : undefined));
    table.measured.push(measured);
  };
  const { measured } = rows;
  let k = 0;
  const readings = (until) => {
    while (k < measured.t.length && measured.t[k] < until) put(measured.t[k], null, measured.value[k++]);
  };
  rows.t.forEach((t, at) => {
    const before = rows.t[at - 1];
    if (t - before > gap) {
      readings(before + gap);
      put(before + gap, { lower: null, upper: null, low: null, mean: null }, undefined);
    }
    readings(t);
    const together = measured.t[k] === t ? measured.value[k++] : undefined;
    put(t, Object.fromEntries(names.map((name) => [name, rows[name][at] ?? null])), together);
  });
  readings(Infinity);
  return [table.t, table.lower, table.upper, table.measured, table.low, table.mean];
}

/** The ends of an axis; nothing that is charted can be below zero, unless it was read so. */
export function widened(low, high) {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  const margin = Math.max(0.08 * (high - low), 0.02 * Math.abs(high), 0.05);
  return [low < 0 ? low - margin : Math.max(0, low - margin), high + margin];
}

/** The place of the time nearest to one, in rows in time order; -1 in none. */
export function nearest(times, t) {
  let [low, high] = [0, times.length - 1];
  if (high < 0) return -1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  return Math.abs(times[low] - t) <= Math.abs(times[high] - t) ? low : high;
}
