// What a line's panel says of it: in this sea, of its wear, and without it.

import { lineIn } from "../lines.js";
import { text } from "../texts/index.js";
import { DASH, day, fixed, half, known, percent, plain, span, withUnit } from "./format.js";
import { intervalOf } from "./load-rows.js";
import { second } from "./parting.js";

/** A number with its interval, in its unit; the mean alone where none is known. */
const ranged = (interval, unit) =>
  (known(interval?.mean) ? [withUnit(interval.mean, unit), half(interval, unit)].filter(Boolean).join(" ") : DASH);

/** The load now, as twin and shackle have it: of bridles alone. */
export function nowRows(name, state) {
  const bridle = state.bridles?.find((one) => one.name === name);
  if (!bridle) return [];
  const rows = [[text("line.now"), ranged(intervalOf(bridle) ?? { mean: bridle.tension_kn.mean }, "kN")]];
  if (bridle.measured_by) rows.push([text("tip.measuredBy", { shackle: plain(bridle.measured_by) }), withUnit(bridle.measured_kn, "kN")]);
  return rows;
}

/** The statistics of half an hour of this sea, and the largest tension of three. */
export function windowRows(name, state) {
  const line = lineIn(state, name);
  if (!line) return [];
  const rows = [[text("lines.heads.mean"), withUnit(line.mean_kn, "kN")]];
  if (known(line.mean_spread_kn)) rows.push([text("line.spread"), `± ${withUnit(line.mean_spread_kn, "kN")}`]);
  rows.push([text("line.std"), withUnit(line.std_kn, "kN")],
    [text("line.maximum"), ranged(line.maximum_3h_kn, "kN")]);
  return rows;
}

/** Why something is missing in the statistics, or how good they are. */
export function windowNote(name, state) {
  const line = lineIn(state, name);
  const words = [
    // Also where there are numbers, as of a sea outside the training domain.
    state.lines_reason || (known(line?.maximum_3h_kn.mean) ? "" : state.reason),
    line && state.tp_assumed ? text("line.tpAssumed") : "",
    line && line.level <= 1 && known(line.maximum_3h_kn.mean) ? levelOne(line) : "",
  ];
  return words.filter(Boolean).join(" ");
}

/** How good numbers of level 1 are: a bridle may have an interval by shackles on others. */
const levelOne = ({ maximum_3h_kn: largest }) =>
  (known(largest.lower) ? text("line.byOthers") : text("line.levelOne"));

/** Damage: of a year of this sea, and what has been counted since when. */
export function wearRows(name, state) {
  const line = lineIn(state, name);
  if (!line) return [];
  const rows = [];
  if (known(line.damage_per_year)) rows.push([text("line.perYear"), text("line.ofLife", { share: small(line.damage_per_year) })]);
  if (known(line.damage)) rows.push([text("line.soFar"), text("line.ofLife", { share: small(line.damage) })]);
  return rows;
}

/** Since when damage is counted, and for how long no answer was there to count. */
export function wearNote(name, state) {
  const line = lineIn(state, name);
  if (!line?.damage_since || !known(line.damage)) return "";
  const hours = (h) => span(3600 * (h ?? 0));
  return text("line.counted", { since: day(Date.parse(line.damage_since)), valid: hours(line.damage_valid_h),
    missing: hours(line.damage_missing_h) });
}

/** What would be without the line; `parted` is the service's answer of it. */
export function partedRows(parted) {
  if (!parted) return [];
  const on = (load) => (load && known(load.kn) ? `${withUnit(load.kn, "kN")}, ${plain(load.line)}` : DASH);
  const rows = [[text("parted.mean"), on(parted.largest_mean)], [text("parted.maximum"), on(parted.largest_maximum_3h)]];
  if (known(parted.utilisation)) rows.push([text("loads.heads.share"), percent(parted.utilisation)]);
  rows.push([text("parted.another"), second(parted)]);
  if (known(parted.volume_share)) rows.push([text("now.figure.volume"), percent(parted.volume_share)]);
  if (known(parted.drift_m)) rows.push([text("parted.drift"), withUnit(parted.drift_m, "m")]);
  if (known(parted.clearance_m)) rows.push([text("parted.clearance"), withUnit(parted.clearance_m, "m")]);
  return rows;
}

/** A share of a life as a percentage of two figures: what is counted is small. */
export function small(share) {
  const value = 100 * share;
  if (value === 0) return "0 %";
  if (value < 0.001) return "<0.001 %";
  return `${fixed(value, Math.max(0, 1 - Math.floor(Math.log10(value))))} %`;
}
