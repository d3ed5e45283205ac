// Actions on an alarm, and for how long one can be shelved.

import { text } from "../texts/index.js";

/** Actions that demand a reason. */
export const REASONED = new Set(["comment", "shelve", "out-of-service", "in-service"]);

const UNIT_S = { minutes: 60, hours: 3600, days: 86400 };
const SHELVES = [
  [15, "minutes"], [1, "hours"], [4, "hours"], [8, "hours"], [1, "days"], [3, "days"], [7, "days"],
];

/** The names of the actions that make sense for an alarm as it is, the likeliest first. */
export function actionsFor(alarm) {
  const seen = alarm.acknowledged ? [] : ["acknowledge"];
  if (alarm.in_service === false) return [...seen, "in-service", "comment"];
  return [...seen, alarm.shelved ? "unshelve" : "shelve", "comment", "out-of-service"];
}

/** How long an alarm can be shelved, as [words, seconds]: one that is active also until it clears. */
export function shelvesFor({ active }) {
  const times = SHELVES.map(([count, unit]) => [text(`dialog.shelf.${unit}`, { count }), count * UNIT_S[unit]]);
  return active ? [...times, [text("dialog.cleared"), null]] : times;
}
