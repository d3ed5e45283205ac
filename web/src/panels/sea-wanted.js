// The sea of a what-if: what can be chosen of it, and where it begins.

import { text } from "../texts/index.js";
import { decimalsIn, shown } from "../units.js";
import { localDigits, withUnit } from "./format.js";

const ROOM = 1.25; // beyond what was learned, to see what extrapolating says
const KINDS = [
  { name: "current", speed: { key: "current_speed_m_s", unit: "m/s", step: 0.01, decimals: 2 },
    way: { key: "current_to_deg", kind: "to" } },
  { name: "waves", speed: { key: "hs_m", unit: "m", step: 0.05, decimals: 2 },
    way: { key: "wave_from_deg", kind: "from" } },
];
const CALM = { current_speed_m_s: 0.4, current_to_deg: 90, hs_m: 0, wave_from_deg: 270 };

/** What can be chosen, by what the twin has learned: a strength and a direction of each kind. */
export function choices({ inputs }) {
  return KINDS.flatMap(({ name, speed, way }) => {
    const learned = inputs.find(({ key }) => key === speed.key);
    if (!learned) return [];
    const most = Number((Math.ceil((ROOM * learned.most) / speed.step) * speed.step).toFixed(3));
    return [{
      speed: { ...speed, name: text(`whatif.sea.${name}.speed`), least: 0, most, learned },
      way: { ...way, name: text(`whatif.sea.${name}.way`) },
      called: text(`whatif.sea.${name}.called`),
    }];
  });
}

/** What can be chosen and what this twin has not learned, in words. */
export function introduced({ inputs }) {
  const waves = inputs.some(({ key }) => key === "hs_m");
  return text("whatif.move", {
    kinds: choices({ inputs }).map(({ called }) => called).join(text("whatif.and")),
    period: period(inputs.some(({ key }) => key === "tp_s"), waves),
  });
}

function period(known, waves) {
  if (known) return text("whatif.steepest");
  return waves ? text("whatif.period") : text("whatif.noWaves");
}

/** Up to where the twin has learned. */
export const learnedWords = ({ learned, unit, decimals }) =>
  text("whatif.learned", { most: withUnit(learned.most, unit, decimals) });

/** A sea to begin with: the one of now, and where it is not known, a calm one. */
export function seaNow(kinds, water) {
  const sea = {};
  for (const { speed: { key, least, most, step }, way } of kinds) {
    const within = Math.min(most, Math.max(least, water?.[key] ?? CALM[key]));
    sea[key] = Number((Math.round(within / step) * step).toFixed(3));
    sea[way.key] = Math.round(water?.[way.key] ?? CALM[way.key]) % 360;
  }
  return sea;
}

/** The change from now to then, with its sign. */
export function change(now, then, unit, decimals) {
  if (!Number.isFinite(now) || !Number.isFinite(then)) return "";
  const difference = shown(then - now, unit);
  const digits = Math.abs(difference).toFixed(decimalsIn(unit, decimals));
  if (Number(digits) === 0) return text("whatif.unchanged");
  return `${difference > 0 ? "+" : "−"}${localDigits(digits)}`;
}
