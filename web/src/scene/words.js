// Words on a node, a bridle or a sensor that the reader points at.

import { knownLoad } from "../known-load.js";
import { lineIn } from "../lines.js";
import { DASH, amount, bearing, fixed, known, localDigits, plain, withUnit } from "../panels/format.js";
import { text } from "../texts/index.js";
import { bearingOf } from "./geometry.js";

/** How long, in the largest unit that says something. */
export function lasting(seconds) {
  if (seconds === null || seconds === undefined) return DASH;
  if (seconds < 90) return text("span.seconds", { count: Math.round(seconds) });
  if (seconds < 5400) return text("span.minutes", { count: Math.round(seconds / 60) });
  return seconds < 172800 ? text("span.hours", { count: localDigits((seconds / 3600).toFixed(1)) })
    : text("span.shortDays", { count: Math.round(seconds / 86400) });
}

/** {title, rows: [[name, value]], note} of what a selection names; null where it names nothing. */
export function wordsFor(selection, topology, view) {
  if (!selection || !topology || !view) return null;
  if (selection.bridle !== undefined) return ofBridle(selection.bridle, topology, view.state);
  if (selection.line !== undefined) return ofLine(selection.line, view.state);
  if (selection.sensor !== undefined) return ofSensor(selection.sensor, topology, view.state);
  return ofNode(selection.node, topology, view);
}

function ofNode(node, { rest, rings, spokes }, { position, sigma, state }) {
  const tip = node === rings * spokes;
  const at = [0, 1, 2].map((axis) => (position ?? rest)[3 * node + axis]);
  const still = [0, 1, 2].map((axis) => rest[3 * node + axis]);
  const side = bearing(bearingOf(still[0], still[1]));
  const title = tip ? text("tip.cone")
    : text("tip.node", { ring: Math.floor(node / spokes) + 1, rings, direction: side });
  const rows = [[text("tip.depth"), withUnit(-at[2], "m", 2)],
    [text("tip.place"), `${amount(at[0], "m")}, ${withUnit(at[1], "m")}`]];
  if (!position) return { title, rows, note: text("tip.still") };
  rows.push([text("tip.moved"), withUnit(Math.hypot(...at.map((x, k) => x - still[k])), "m", 2)],
    [text("tip.sigma"), sigma ? withUnit(sigma[node], "m", 2) : text("number.notKnown")]);
  return { title, rows, note: sigma ? "" : noSpread(state) };
}

/** Why no spread of the shape is known, in a sentence. */
export const noSpread = (state) =>
  state?.shape?.interval_reason || text("tip.noSpread");

function ofBridle(name, topology, state) {
  const k = topology.bridle_names.indexOf(name);
  const bridle = state.bridles[k];
  if (!bridle) return null;
  const kn = bridle.tension_kn;
  const load = knownLoad(bridle, state);
  const rows = [[text("tip.tension"), withUnit(kn.mean, "kN")],
    [text("mark.interval"), interval(kn, 1, "kN")],
    [text("tip.share"), load ? text("tip.shareOf", { share: fixed(100 * load.share, 0),
      capacity: withUnit(topology.bridle_capacity_kn[k], "kN", 0) }) : DASH]];
  const shackle = topology.shackles.find((one) => one.bridle === k);
  if (shackle) rows.push([text("tip.measuredBy", { shackle: shackle.name }), withUnit(bridle.measured_kn, "kN")]);
  return { title: name, rows, note: level(bridle, state) };
}

function ofLine(name, state) {
  const line = lineIn(state, name);
  if (!line) return { title: plain(name), rows: [], note: state.lines_reason ?? "" };
  const rows = [[text("lines.heads.mean"), withUnit(line.mean_kn, "kN")],
    [text("mark.maximum"), withUnit(line.maximum_3h_kn.mean, "kN")]];
  return { title: plain(name), rows, note: state.lines_reason ?? "" };
}

function ofSensor(name, topology, state) {
  const sensor = state.sensors.find((one) => one.name === name);
  if (!sensor) return null;
  const decimals = sensor.unit === "m" ? 2 : 1;
  const rows = [
    [text("tip.measured"), reading(sensor, decimals)],
    [text("tip.predicted"), withUnit(sensor.mean, sensor.unit, decimals)],
    [text("mark.interval"), interval(sensor, decimals, sensor.unit)],
    [text("tip.simulated"), withUnit(sensor.low_fidelity, sensor.unit, decimals)],
  ];
  const bridle = topology.shackles.find((one) => one.name === name)?.bridle;
  const place = bridle === undefined ? text("tip.depthSensor")
    : text("charts.on", { bridle: topology.bridle_names[bridle] });
  return { title: `${name}, ${place}`, rows, note: level(sensor, state) };
}

function reading({ measured, measured_age_s: age, unit }, decimals) {
  if (measured === null) return text("tip.nothing");
  const value = withUnit(measured, unit, decimals);
  return age === null ? value : text("tip.ago", { value, age: lasting(age) });
}

/** Interval in words. */
function interval(bounds, decimals, unit) {
  const { mean, lower, upper } = bounds;
  if (mean === null) return DASH;
  if (!known(lower)) return text("number.notKnown");
  return text("number.range", { lower: amount(lower, unit, decimals), upper: withUnit(upper, unit, decimals) });
}

function level({ level: number, in_domain: within = true, interval_reason: why }, state) {
  if (!state.valid) return state.reason || text("tip.invalid");
  if (!state.in_domain) return text("tip.extrapolated");
  if (!within) return text("tip.outside");
  return number > 1 ? text("tip.learned") : [text("tip.simulations"), why].filter(Boolean).join(" ");
}
