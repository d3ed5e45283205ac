// Numbers and times as people read them.

const DASH = "–";
const POINTS = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];

/** A number with so many decimals; a dash where there is none. */
export const fixed = (value, decimals = 1) =>
  value === null || value === undefined ? DASH : value.toFixed(decimals).replace("-", "−");

/** A share as a percentage. */
export const percent = (value) => (value === null ? DASH : `${Math.round(100 * value)} %`);

/** Half the width of an interval. */
export const half = ({ lower, upper }, decimals = 1) =>
  lower === null ? "" : `± ${((upper - lower) / 2).toFixed(decimals)}`;

/** A compass direction in words. */
export const compass = (degrees) => POINTS[Math.round(degrees / 45) % 8];

/** Degrees, three figures as on a bridge. */
export const bearing = (degrees) => `${String(Math.round(degrees) % 360).padStart(3, "0")}°`;

/** How long ago, in the largest unit that says something. */
export function ago(seconds) {
  if (seconds === null) return DASH;
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  if (seconds < 172800) return `${(seconds / 3600).toFixed(1)} h`;
  return `${Math.round(seconds / 86400)} days`;
}

const DAY = new Intl.DateTimeFormat("en-GB", {
  weekday: "short", day: "numeric", month: "short", year: "numeric", timeZone: "UTC",
});
const TIME = new Intl.DateTimeFormat("en-GB", {
  hour: "2-digit", minute: "2-digit", timeZone: "UTC",
});

/** Day and time, UTC. */
export const day = (t) => DAY.format(t);
export const time = (t) => TIME.format(t);

/** Round numbers that span a range, about so many. */
export function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
  const first = Math.ceil(low / step - 1e-9) * step;
  const marks = [];
  for (let k = 0; first + k * step <= high + 1e-9 * step; k += 1) marks.push(first + k * step);
  return { marks, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}
