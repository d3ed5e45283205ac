// The past as columns: the service's history, and what has come since.
// Times are in s since 1970 UTC, as uPlot has them.

import { possibleSeries } from "../bounds.js";
import { sentences } from "../service-words.js";

const FAIL = 4; // of QARTOD
const SAME_S = 0.002; // ages are rounded to a millisecond

/** Read a history of the service. */
export function columnsOf(history) {
  const series = (table) => Object.fromEntries(Object.entries(table).map(([name, raw]) => {
    const one = possibleSeries(raw);
    return [name, { unit: one.unit, level: one.level, reason: sentences(one.interval_reason ?? ""),
      low: one.low_fidelity, mean: one.mean,
      lower: one.lower ?? one.mean.map(() => null), upper: one.upper ?? one.mean.map(() => null) }];
  }));
  return {
    t: history.t.map(seconds),
    speed: [...history.current_speed_m_s],
    to: [...history.current_to_deg],
    volume: [...history.volume_fraction],
    bridles: series(history.bridles),
    sensors: series(history.sensors),
    measured: Object.fromEntries(Object.entries(history.measured).map(([name, one]) =>
      [name, { t: one.t.map(seconds), value: [...one.value] }])),
  };
}

/** Add a state; one that comes within `step` seconds of the last but one takes the last's place. */
export function append(columns, state, step) {
  const now = seconds(state.t);
  if (now <= (columns.t.at(-1) ?? -Infinity)) return;
  const replaces = columns.fresh && now - columns.t.at(-2) < step;
  const put = (column, value) => {
    if (replaces) column.pop();
    column.push(value ?? null);
  };
  put(columns.t, now);
  put(columns.speed, state.valid ? state.water?.current_speed_m_s : null);
  put(columns.to, state.valid ? state.water?.current_to_deg : null);
  put(columns.volume, state.volume_fraction);
  for (const { name, low_fidelity_kn: low, tension_kn: { mean, lower, upper } } of state.bridles) {
    putAll(columns.bridles[name], { low, mean, lower, upper }, put);
  }
  for (const { name, low_fidelity: low, mean, lower, upper } of state.sensors) {
    putAll(columns.sensors[name], { low, mean, lower, upper }, put);
  }
  columns.fresh = true;
  readings(columns, state, now);
}

function putAll(series, values, put) {
  if (!series) return;
  for (const [name, value] of Object.entries(values)) put(series[name], value);
}

/** Keep what the sensors read, and take back what was shown to be a spike. */
function readings(columns, state, now) {
  for (const { name, measured, measured_age_s: age } of state.sensors) {
    const one = columns.measured[name];
    if (!one || measured === null || measured === undefined) continue;
    const t = now - age;
    if (t > (one.t.at(-1) ?? -Infinity) + SAME_S) {
      one.t.push(t);
      one.value.push(measured);
    }
  }
  for (const { stream, t } of (state.amended ?? []).filter(({ flag }) => flag >= FAIL)) {
    const one = columns.measured[stream];
    const at = one?.t.findIndex((when) => Math.abs(when - seconds(t)) <= SAME_S) ?? -1;
    if (at < 0) continue;
    one.t.splice(at, 1);
    one.value.splice(at, 1);
  }
}

/** Forget what is older than a time. */
export function trim(columns, since) {
  const early = columns.t.findIndex((t) => t >= since);
  const drop = early < 0 ? columns.t.length : early;
  if (drop) {
    const all = [columns.t, columns.speed, columns.to, columns.volume];
    for (const one of [...Object.values(columns.bridles), ...Object.values(columns.sensors)]) {
      all.push(one.low, one.mean, one.lower, one.upper);
    }
    for (const column of all) column.splice(0, drop);
  }
  for (const one of Object.values(columns.measured)) {
    const first = one.t.findIndex((t) => t >= since);
    const gone = first < 0 ? one.t.length : first;
    one.t.splice(0, gone);
    one.value.splice(0, gone);
  }
}

const seconds = (stamp) => Date.parse(stamp) / 1000;
