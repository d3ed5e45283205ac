// What is said of a node, a bridle or a sensor that the reader points at.

import { knownLoad } from "../known-load.js";
import { bearingOf } from "./geometry.js";

const MINUS = "−";

/** A number with its unit; a dash where there is none. */
export const fixed = (value, decimals, unit = "") =>
  value === null || value === undefined || !Number.isFinite(value)
    ? "–" : `${rounded(value, decimals).replace("-", MINUS)}${unit && ` ${unit}`}`;

/** So many decimals; what rounds to nothing has no sign. */
function rounded(value, decimals) {
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text;
}

/** Degrees in three figures, as on a bridge. */
export const bearing = (degrees) => `${String(Math.round(degrees) % 360).padStart(3, "0")}°`;

/** How long, in the largest unit that says something. */
export function lasting(seconds) {
  if (seconds === null || seconds === undefined) return "–";
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return seconds < 172800 ? `${(seconds / 3600).toFixed(1)} h` : `${Math.round(seconds / 86400)} d`;
}

const range = ({ lower, upper }, decimals, unit) =>
  lower === null ? "–" : `${fixed(lower, decimals)} to ${fixed(upper, decimals, unit)}`;

/** {title, rows: [[name, value]], note} of what a selection names; null where it names nothing. */
export function wordsFor(selection, topology, view) {
  if (!selection || !topology || !view) return null;
  if (selection.bridle !== undefined) return ofBridle(selection.bridle, topology, view.state);
  if (selection.sensor !== undefined) return ofSensor(selection.sensor, topology, view.state);
  return ofNode(selection.node, topology, view);
}

function ofNode(node, { rest, rings, spokes }, { position, sigma, state }) {
  const tip = node === rings * spokes;
  const at = [0, 1, 2].map((axis) => (position ?? rest)[3 * node + axis]);
  const still = [0, 1, 2].map((axis) => rest[3 * node + axis]);
  const side = bearing(bearingOf(still[0], still[1]));
  const title = tip ? "Tip of the cone"
    : `Net, ring ${Math.floor(node / spokes) + 1} of ${rings}, towards ${side}`;
  const rows = [["Depth", fixed(-at[2], 2, "m")],
    ["East, north", `${fixed(at[0], 1)}, ${fixed(at[1], 1, "m")}`]];
  if (!position) return { title, rows, note: "In still water: there is no valid input." };
  rows.push(["Moved from rest", fixed(Math.hypot(...at.map((x, k) => x - still[k])), 2, "m")],
    ["Uncertainty, σ", sigma ? fixed(sigma[node], 2, "m") : "not known"]);
  return { title, rows, note: sigma ? "" : noSpread(state) };
}

/** Why no spread of the shape is known, in a sentence. */
export const noSpread = (state) =>
  state?.shape?.interval_reason || "How far the net may be from here is not known.";

function ofBridle(name, topology, state) {
  const k = topology.bridle_names.indexOf(name);
  const bridle = state.bridles[k];
  if (!bridle) return null;
  const kn = bridle.tension_kn;
  const load = knownLoad(bridle, state);
  const rows = [["Tension", fixed(kn.mean, 1, "kN")],
    ["95 % interval", interval(bridle, kn, 1, "kN")],
    ["Of its capacity", load
      ? `${fixed(100 * load.share, 0)} % of ${fixed(topology.bridle_capacity_kn[k], 0, "kN")}` : "–"]];
  const shackle = topology.shackles.find((one) => one.bridle === k);
  if (shackle) rows.push([`Measured, ${shackle.name}`, fixed(bridle.measured_kn, 1, "kN")]);
  return { title: name, rows, note: level(bridle, state) };
}

function ofSensor(name, topology, state) {
  const sensor = state.sensors.find((one) => one.name === name);
  if (!sensor) return null;
  const decimals = sensor.unit === "m" ? 2 : 1;
  const age = sensor.measured_age_s;
  const rows = [
    ["Measured", sensor.measured === null ? "– (nothing valid of late)"
      : `${fixed(sensor.measured, decimals, sensor.unit)}${age === null ? "" : `, ${lasting(age)} ago`}`],
    ["Predicted", fixed(sensor.mean, decimals, sensor.unit)],
    ["95 % interval", interval(sensor, sensor, decimals, sensor.unit)],
    ["Simulation alone", fixed(sensor.low_fidelity, decimals, sensor.unit)],
  ];
  const bridle = topology.shackles.find((one) => one.name === name)?.bridle;
  const on = bridle === undefined ? "depth sensor on the net" : `on ${topology.bridle_names[bridle]}`;
  return { title: `${name}, ${on}`, rows, note: level(sensor, state) };
}

/** How far the simulation alone is off at sea, nobody knows. */
function interval({ level: number }, bounds, decimals, unit) {
  if (bounds.mean === null) return "–";
  return number > 1 && Number.isFinite(bounds.lower) ? range(bounds, decimals, unit) : "not known";
}

function level({ level: number, in_domain: within = true, interval_reason: why }, { valid, in_domain: inDomain, reason }) {
  if (!valid) return reason || "There is no valid input.";
  if (!inDomain) return "Extrapolated beyond what was learned.";
  if (!within) return "Outside the training domain of its own level.";
  return number > 1 ? "Learned from measurements." : `From simulations alone. ${why ?? ""}`.trim();
}
