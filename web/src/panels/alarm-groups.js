// Alarms of one cause, told and acknowledged as one.

import { counted } from "./format.js";
import { waits } from "./ranks.js";

const TOGETHER_MS = 15 * 60e3; // of one cause, what begins within so long of what began before
const SILENCE = new Set(["silent", "input"]); // a buoy that is silent gives no input
const TITLES = {
  silent: (count) => `${counted(count, "stream")} without readings`,
  load: (count) => `High load on ${counted(count, "bridle")}`,
  clock: (count) => `${counted(count, "clock")} that disagree`,
  irregular: (count) => `${counted(count, "sensor")} that read irregularly`,
  bridle: (count) => `${counted(count, "bridle")} that may have parted`,
  history: (count) => `${counted(count, "fault")} of the service`,
};

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
  if (group.length === 1) return group[0].title;
  const words = TITLES[family(group[0])];
  return words ? words(group.length) : `${group[0].title}, and ${group.length - 1} more of one cause`;
}

/** Those of a group that nobody has acknowledged. */
export const unseen = (group) => group.filter((alarm) => waits(alarm) && !alarm.acknowledged);
