// Colour scales that read the same to every eye, and the colours of alarms.

import { rank } from "../panels/ranks.js";

// Matplotlib's viridis and cividis (CC0), at eleven even steps.
const SCALES = {
  viridis: "440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725",
  cividis: "00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 e1cc55 f2da4a fee838",
};
const parts = (hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
const STOPS = Object.fromEntries(Object.entries(SCALES).map(([name, stops]) =>
  [name, stops.split(" ").map(parts)]));
// What stands out from the ground: the darkest part is lost at night, the brightest by day.
const SPAN = { dark: [0.3, 1], light: [0, 0.86] };

/** The colour at a share 0..1 of a scale, as [r, g, b] of 0..255. */
export function scaleColour(share, { scale = "viridis", theme = "dark" } = {}) {
  const [from, to] = SPAN[theme];
  const at = 10 * (from + (to - from) * Math.min(1, Math.max(0, share)));
  const low = Math.min(9, Math.floor(at));
  const [a, b] = [STOPS[scale][low], STOPS[scale][low + 1]];
  return a.map((one, k) => one + (b[k] - one) * (at - low));
}

/** The same in CSS. */
export const cssColour = (share, how) =>
  `rgb(${scaleColour(share, how).map(Math.round).join(", ")})`;

/** A scale as a CSS gradient, from left to right. */
export function gradient(how) {
  const stops = Array.from({ length: 9 }, (_, k) => cssColour(k / 8, how));
  return `linear-gradient(90deg, ${stops.join(", ")})`;
}

/** The worst rank of the active alarms on each bridle and sensor, by name. */
export function alarmed(state) {
  const worst = new Map();
  for (const { id, severity, active, shelved } of state?.alarms ?? []) {
    const source = id.slice(id.indexOf(".") + 1);
    if (active && !shelved && severity > (worst.get(source) ?? 0)) worst.set(source, severity);
  }
  return new Map([...worst].map(([source, severity]) => [source, rank(severity)]));
}
