// The sea of a what-if: what can be chosen of it, and where it begins.

const ROOM = 1.25; // beyond what was learned, to see what extrapolating says
const KINDS = [
  { speed: { key: "current_speed_m_s", name: "Current", unit: "m/s", step: 0.01, decimals: 2 },
    way: { key: "current_to_deg", name: "Current towards", kind: "to" }, called: "the current" },
  { speed: { key: "hs_m", name: "Height Hs", unit: "m", step: 0.05, decimals: 2 },
    way: { key: "wave_from_deg", name: "Waves from", kind: "from" }, called: "waves" },
];
const NOT_KNOWN = "Waves are not among what this twin has learned: it says nothing of what they do.";
const PERIOD = "The twin has learned from seas whose period goes with their height.";
const CALM = { current_speed_m_s: 0.4, current_to_deg: 90, hs_m: 0, wave_from_deg: 270 };

/** What can be chosen, by what the twin has learned: a strength and a direction of each kind. */
export function choices({ inputs }) {
  return KINDS.flatMap(({ speed, way, called }) => {
    const learned = inputs.find(({ key }) => key === speed.key);
    if (!learned) return [];
    const most = Number((Math.ceil((ROOM * learned.most) / speed.step) * speed.step).toFixed(3));
    return [{ speed: { ...speed, least: 0, most, learned }, way, called }];
  });
}

/** Say in words what can be asked, and what this twin does not know. */
export function introduced({ inputs }) {
  const kinds = choices({ inputs });
  return `Move ${kinds.map(({ called }) => called).join(" and ")}: the net and the loads answer at once. ` +
    `${inputs.some(({ key }) => key === "hs_m") ? PERIOD : NOT_KNOWN} Nothing here touches the cage.`;
}

/** Up to where the twin has learned. */
export const learnedWords = ({ learned, unit, decimals }) =>
  `learned up to ${learned.most.toFixed(decimals)} ${unit}`;

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
export function change(now, then, decimals) {
  if (!Number.isFinite(now) || !Number.isFinite(then)) return "";
  const difference = then - now;
  const text = Math.abs(difference).toFixed(decimals);
  if (Number(text) === 0) return "no change";
  return `${difference > 0 ? "+" : "−"}${text}`;
}
