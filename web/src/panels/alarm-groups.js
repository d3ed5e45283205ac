// Alarms of one cause, shown and acknowledged as one.

import { text } from "../texts/index.js";
import { waits } from "./ranks.js";

const TOGETHER_MS = 15 * 60e3; // of one cause, what begins within so long of what began before
const SILENCE = new Set(["silent", "input"]); // a buoy that is silent gives no input
const TITLED = new Set(["silent", "load", "clock", "irregular", "bridle", "history"]);

const kindOf = ({ id }) => id.slice(0, id.indexOf("."));
const family = (alarm) => (SILENCE.has(kindOf(alarm)) ? "silent" : kindOf(alarm));

/** Since when the cause was there [ms]: a stream fell silent its timeout before the alarm. */
function onset(alarm) {
  const since = alarm.since ? Date.parse(alarm.since) : 0;
  return since - (kindOf(alarm) === "silent" ? 1000 * (alarm.raise_at ?? 0) : 0);
}

/** Only what stands alike is one: an active alarm never hides in a group that has cleared. */
const standing = (alarm) =>
  [family(alarm), alarm.active, Boolean(alarm.shelved), alarm.in_service !== false].join();

/**
 * Alarms that have one cause: the same kind of thing, begun at about the same time, and standing
 * alike. The groups and what is in them keep the order in which they came.
 */
export function grouped(alarms) {
  const groups = [];
  for (const one of [...alarms].sort((a, b) => onset(a) - onset(b))) {
    const group = groups.find((other) => standing(other[0]) === standing(one)
      && (onset(one) - onset(other.at(-1)) <= TOGETHER_MS));
    if (group) group.push(one);
    else groups.push([one]);
  }
  const place = (one) => alarms.indexOf(one);
  return groups.map((group) => group.sort((a, b) => place(a) - place(b)))
    .sort((a, b) => place(a[0]) - place(b[0]));
}

/** What a group is called; one alarm alone by its own title. */
export function titleOf(group) {
  const [first, ...others] = group;
  if (!others.length) return first.title;
  const kind = family(first);
  return TITLED.has(kind) ? text(`groups.kind.${kind}`, { count: group.length })
    : text("groups.other", { title: first.title, count: others.length });
}

/** Those of a group that nobody has acknowledged. */
export const unseen = (group) => group.filter((alarm) => waits(alarm) && !alarm.acknowledged);
