import assert from "node:assert/strict";
import { test } from "node:test";

import { kpiRows } from "../../src/panels/kpi-rows.js";

const none = { raised: {}, standing: {}, longest_s: {}, chattering: [] };

test("a quiet span has no rows", () => {
  assert.deepEqual(kpiRows(none), []);
});

test("the alarm raised most often comes first, then the one that stood longest", () => {
  const rows = kpiRows({ ...none, raised: { a: 1, b: 3, c: 1 }, longest_s: { a: 5, b: 1, c: 9 } });
  assert.deepEqual(rows.map(({ name }) => name), ["b", "c", "a"]);
});

test("an alarm that was there before the span has its row", () => {
  const [row] = kpiRows({ ...none, standing: { a: "2026-01-01T00:00:00Z" }, longest_s: { a: 60 } });
  assert.deepEqual(row, { name: "a", raised: 0, longestS: 60, state: "standing" });
});

test("one that stands and chatters is shown as both", () => {
  const [row] = kpiRows({ raised: { a: 4 }, standing: { a: "x" }, longest_s: {}, chattering: ["a"] });
  assert.deepEqual([row.state, row.longestS], ["standing, chattering", null]);
});
