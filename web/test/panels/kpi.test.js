import assert from "node:assert/strict";
import { test } from "node:test";

import { counted } from "../../src/panels/kpi-counts.js";

const HOUR = 3600e3;
const line = (alarm, action, minutes) => ({ alarm, action, t: new Date(60e3 * minutes).toISOString() });
const over = (lines) => counted(lines, { start: 0, end: 24 * HOUR });

test("a quiet day counts nothing", () => {
  const counts = over([]);
  assert.deepEqual([counts.raised, counts.perDay, counts.standing, counts.longestS, counts.seenAfterS],
    [0, 0, 0, 0, null]);
});

test("an alarm that is raised and cleared has its length", () => {
  const counts = over([line("a", "raised", 10), line("a", "acknowledged", 12), line("a", "cleared", 40)]);
  assert.deepEqual([counts.raised, counts.perDay, counts.standing, counts.longestS, counts.seenAfterS],
    [1, 1, 0, 1800, 120]);
});

test("an alarm that has not cleared stands, up to the end", () => {
  const counts = over([line("a", "raised", 23 * 60)]);
  assert.deepEqual([counts.standing, counts.longestS], [1, 3600]);
});

test("an alarm that was there before the span counts from its begin", () => {
  const { each } = over([line("a", "cleared", 30)]);
  assert.deepEqual([each[0].raised, each[0].longestS], [0, 1800]);
});

test("three times within ten minutes is chattering, within an hour is not", () => {
  const times = (minutes) => minutes.flatMap((m) => [line("a", "raised", m), line("a", "cleared", m + 1)]);
  assert.equal(over(times([0, 4, 8])).chattering, 1);
  assert.equal(over(times([0, 20, 40])).chattering, 0);
});

test("the alarm raised most often comes first", () => {
  const { each } = over([line("a", "raised", 1), line("b", "raised", 2), line("b", "cleared", 3), line("b", "raised", 4)]);
  assert.deepEqual(each.map(({ name }) => name), ["b", "a"]);
});
