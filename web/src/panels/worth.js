// The number of an alarm, where it says something to a person.

import { percent, span } from "./format.js";

const WORDS = { load: percent, volume: percent, silent: span };

/** The number in words; empty where there is none, or where it is only a measure of the test. */
export function worth(id, value) {
  const words = WORDS[id.slice(0, id.indexOf("."))];
  return words && Number.isFinite(value) ? words(value) : "";
}
