// How bad an alarm is, and which comes first.

import { text } from "../texts/index.js";

const CRITICAL = 800;
const WARNING = 500;

/** critical, warning or note, of a severity from 1 to 1000. */
export function rank(severity) {
  if (severity >= CRITICAL) return "critical";
  return severity >= WARNING ? "warning" : "note";
}

/** Whether somebody should look at it: its cause is there, or was and nobody has seen it. */
export const waits = (alarm) =>
  (alarm.active || !alarm.acknowledged) && !alarm.shelved && alarm.in_service !== false;

/** What an alarm is doing, in words. */
export function standing(alarm) {
  if (alarm.in_service === false) return text("standing.outOfService");
  if (alarm.shelved) return text("standing.shelved");
  if (alarm.active) return alarm.acknowledged ? text("standing.active") : text("standing.activeUnseen");
  return alarm.acknowledged ? text("standing.cleared") : text("standing.clearedUnseen");
}

/** Order: those that are active, then those that have cleared and that nobody has seen, then those
 * that are put aside; of each those nobody has seen first, then by severity, then newest. */
export function ordered(alarms) {
  const place = (alarm) =>
    (!waits(alarm) ? 4 : alarm.active ? 0 : 2) + (waits(alarm) && alarm.acknowledged ? 1 : 0);
  const since = (alarm) => (alarm.since ? Date.parse(alarm.since) : 0);
  return [...alarms].sort(
    (a, b) => place(a) - place(b) || b.severity - a.severity || since(b) - since(a));
}

/** The worst of those that wait, one that is active before one that has cleared; null if none. */
export function worst(alarms) {
  const waiting = alarms.filter(waits);
  const isWorse = (a, b) =>
    (a.active === b.active ? a.severity > b.severity : a.active);
  return waiting.length ? waiting.reduce((a, b) => (isWorse(b, a) ? b : a)) : null;
}
