// Units and clock as the reader chose them, remembered by the browser; the service stays SI and UTC.

import { Observable } from "./observable.js";

const KEY = "seacage-units";
const same = (decimals) => decimals;
// By the unit that the service has: what each choice is called, how many of it go into one, and
// how many decimals say as much.
const UNITS = {
  kN: { kN: [1, same], tf: [1 / 9.80665, (decimals) => decimals + 1] },
  "m/s": { "m/s": [1, same], kn: [3600 / 1852, same] },
  m: { m: [1, same], ft: [1 / 0.3048, (decimals) => Math.min(decimals, 1)] },
};
const CLOCKS = ["utc", "browser", "site"];

/** What can be chosen: [[name, choices]], the service's own first. */
export const CHOICES = [...Object.entries(UNITS).map(([unit, kinds]) => [unit, Object.keys(kinds)]), ["clock", CLOCKS]];

const changes = new Observable();
const chosen = Object.fromEntries(CHOICES.map(([name, [first]]) => [name, first]));
let site = null; // the site's named time zone, where the service knows it

try {
  const kept = JSON.parse(globalThis.localStorage?.getItem(KEY) ?? "{}");
  for (const [name, choices] of CHOICES) if (choices.includes(kept[name])) chosen[name] = kept[name];
} catch {
  localStorage.removeItem(KEY); // not ours: begin anew
}

/** Call `fn` whenever a choice changes. */
export const onUnits = (fn) => changes.on(fn);

/** What is chosen for a unit of the service, or for the clock. */
export const choiceOf = (name) => chosen[name];

/** Choose, for this visit and the next. */
export function choose(name, choice) {
  chosen[name] = choice;
  globalThis.localStorage?.setItem(KEY, JSON.stringify(chosen));
  changes.notify(name);
}

/** Take the named time zone of the site; null where none is known. */
export function setSiteZone(zone) {
  site = zone ?? null;
}

/** Whether the site's own time zone is known. */
export const hasSiteZone = () => site !== null;

const how = (unit) => UNITS[unit]?.[chosen[unit]] ?? [1, same];

/** The name of what is shown for a unit of the service. */
export const unitName = (unit) => chosen[unit] ?? unit;

/** A number in a unit of the service as one in the unit that is shown; null stays. */
export const shown = (value, unit) => (Number.isFinite(value) ? value * how(unit)[0] : value);

/** How many decimals say as much in the unit that is shown. */
export const decimalsIn = (unit, decimals) => how(unit)[1](decimals);

/** The IANA name of the time zone that is shown. */
export function zone() {
  if (chosen.clock === "browser") return Intl.DateTimeFormat().resolvedOptions().timeZone;
  return (chosen.clock === "site" && site) || "UTC";
}
