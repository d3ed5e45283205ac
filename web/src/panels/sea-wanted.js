// The sea of a what-if: what can be chosen, and where it begins.

export const CHOICES = [
  { key: "current_speed_m_s", name: "Current", unit: "m/s", least: 0, most: 1.5, step: 0.01, decimals: 2 },
  { key: "hs_m", name: "Height Hs", unit: "m", least: 0, most: 6, step: 0.05, decimals: 2 },
  { key: "tp_s", name: "Period Tp", unit: "s", least: 2, most: 16, step: 0.1, decimals: 1 },
];

const CALM = { current_speed_m_s: 0.4, current_to_deg: 90, hs_m: 0, tp_s: null, wave_from_deg: 270 };

/** A sea to begin with: the one of now, and where it is not known, a calm one. */
export function seaNow(water) {
  const begin = Object.entries(CALM).map(([key, calm]) => [key, water?.[key] ?? calm]);
  const sea = Object.fromEntries(begin);
  for (const { key, least, most, step } of CHOICES) {
    if (sea[key] === null) continue;
    const within = Math.min(most, Math.max(least, sea[key]));
    sea[key] = Number((Math.round(within / step) * step).toFixed(3));
  }
  for (const key of ["current_to_deg", "wave_from_deg"]) sea[key] = Math.round(sea[key]) % 360;
  return sea;
}

/** The change from now to then, with its sign. */
export function change(now, then, decimals) {
  if (!Number.isFinite(now) || !Number.isFinite(then)) return "";
  const difference = then - now;
  const text = Math.abs(difference).toFixed(decimals);
  if (Number(text) === 0) return "no change";
  return `${difference > 0 ? "+" : "−"}${text}`;
}
