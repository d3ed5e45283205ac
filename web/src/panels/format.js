// Numbers and times as people read them: no number without a value behind it, no value
// without its unit.

import { has, language, text } from "../texts/index.js";
import { decimalsIn, shown, unitName, zone } from "../units.js";

export const DASH = "–";
const [POINTS, NAMES] = [text("compass.points").split(" "), text("compass.names").split(" ")];

const [MARK] = new Intl.NumberFormat(language).formatToParts(0.5).filter(({ type }) => type === "decimal");

/** Digits with the decimal mark of the language in place of a point. */
export const localDigits = (digits) => digits.replace(".", MARK.value);

/** Whether there is a number. */
export const known = (value) => Number.isFinite(value);

/** A number with so many decimals; a dash where there is none. What rounds to nothing has no sign. */
export function fixed(value, decimals = 1) {
  if (!known(value)) return DASH;
  const digits = value.toFixed(decimals);
  return localDigits(digits.replace("-", Number(digits) === 0 ? "" : "−"));
}

/** A number that the service has in a unit, in the one that is shown, without its name. */
export const amount = (value, unit, decimals = 1) => fixed(shown(value, unit), decimalsIn(unit, decimals));

/** The same with the name of the unit that is shown. */
export const withUnit = (value, unit, decimals = 1) =>
  known(value) ? `${amount(value, unit, decimals)} ${unitName(unit)}` : DASH;

/** A share as a percentage. */
export const percent = (share) => (known(share) ? `${Math.round(100 * share)} %` : DASH);

/** Words in which no line ends between a number and its unit. */
export const unbroken = (words) =>
  words.replace(/(\d) (?=%|(?:kN|tf|m\/s|kn|m|ft|s|min|h|t|døgn|deg)\b)/g, "$1\u00a0");

/**
 * An interval, as what follows the mean: half its width, never given as zero; its ends where
 * it reaches less far to one side, as where nothing can be below zero.
 */
export function half(interval, unit, places = 1) {
  const decimals = decimalsIn(unit, places);
  const [mean, lower, upper] = ["mean", "lower", "upper"].map((end) => shown(interval?.[end], unit));
  if (!known(lower) || !known(upper)) return "";
  const middle = (lower + upper) / 2;
  if (known(mean) && Math.abs(middle - mean) > 0.6 * 10 ** -decimals) {
    return `(${text("number.range", { lower: fixed(lower, decimals), upper: fixed(upper, decimals) })})`;
  }
  const digits = ((upper - lower) / 2).toFixed(decimals);
  return localDigits(Number(digits) ? `± ${digits}` : `± <${(10 ** -decimals).toFixed(decimals)}`);
}

/** Why the twin extrapolates, without the word that stands before it anyway. */
export function beyond(reason) {
  const words = (reason ?? "").replace(/^Extrapolating:\s*/, "");
  return words ? capital(words) : text("beyond");
}

/** A compass direction as its point, e.g. WSW. */
export const compass = (degrees) =>
  known(degrees) ? POINTS[Math.round(turned(degrees) / 22.5) % 16] : "";

/** A compass direction in a word, for those who listen. */
export const spoken = (degrees) =>
  known(degrees) ? NAMES[Math.round(turned(degrees) / 45) % 8] : text("compass.unknown");

/** Degrees with three figures, as on a bridge. */
export const bearing = (degrees) =>
  known(degrees) ? `${String(Math.round(turned(degrees)) % 360).padStart(3, "0")}°` : DASH;

/** An angle brought into 0 to 360. */
export const turned = (degrees) => ((degrees % 360) + 360) % 360;

/** A length of time in the largest unit that says something. */
export function span(seconds) {
  if (!known(seconds)) return DASH;
  if (seconds < 90) return text("span.seconds", { count: Math.round(seconds) });
  if (seconds < 5400) return text("span.minutes", { count: Math.round(seconds / 60) });
  if (seconds < 172800) return text("span.hours", { count: localDigits((seconds / 3600).toFixed(1).replace(".0", "")) });
  return text("span.days", { count: Math.round(seconds / 86400) });
}

/** The age of the newest input [s], in words. */
export const inputAge = (age) => (known(age) ? text("bar.age", { age: span(age) }) : text("bar.noInput"));

const clocks = new Map();

/** A formatter of a time zone, made once: that takes long. */
function clock(options) {
  const key = JSON.stringify([zone(), options]);
  if (!clocks.has(key)) clocks.set(key, new Intl.DateTimeFormat(text("dates.locale"), { timeZone: zone(), ...options }));
  return clocks.get(key);
}

/** The day by the clock that is shown; in English as in ISO 8601, which is the Swedish way. */
export const day = (t) => clock({ year: "numeric", month: "2-digit", day: "2-digit" }).format(t);

/** The same without its year. */
export const dayOfYear = (t) => day(t).replace(/^\d{4}\D|\D\d{4}$/, "");

/** The time of day by the clock that is shown. */
export const time = (t, seconds = false) => clock({ timeStyle: seconds ? "medium" : "short" }).format(t);

/** What the clock that is shown is called at a time, such as UTC or GMT+1. */
export const zoneName = (t) => (zone() === "UTC" ? "UTC"
  : clock({ timeZoneName: "shortOffset" }).formatToParts(t).find(({ type }) => type === "timeZoneName").value);

/** Day and time, with what the clock is called. */
export const moment = (t) => `${day(t)} ${time(t)} ${zoneName(t)}`;

/** A name as people write it: bridle-3 is "bridle 3", in the language's word for it. */
export function plain(name) {
  const [kind, ...rest] = name.split("-");
  return [has(`name.${kind}`) ? text(`name.${kind}`) : kind, ...rest].join(" ");
}

/** Words with a large first letter, to begin a line. */
export const capital = (words) => words.replace(/^./, (letter) => letter.toUpperCase());

/** A name to begin a line. */
export const titled = (name) => capital(plain(name));
