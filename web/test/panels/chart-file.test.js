// What is saved of a chart says its unit, its times and how its numbers were made.

import assert from "node:assert/strict";
import { test } from "node:test";

globalThis.matchMedia = () => ({ matches: false, addEventListener() {} });
globalThis.localStorage = { getItem: () => null, setItem() {} };
globalThis.document = { documentElement: { dataset: {} } };
const { csvOf } = await import("../../src/panels/chart-file.js");
const { choose } = await import("../../src/units.js");

// t, lower, upper, measured, low, mean
const rows = [[0, 60, 90, 120], [1, null, null, undefined], [3, null, null, undefined],
  [undefined, undefined, null, 2.5], [1.8, 2, null, undefined], [2, 2.1000000001, null, undefined]];

test("a table has units in its heads, ISO times in UTC, and its origin in each row", () => {
  const lines = csvOf(rows, { unit: "kN", origin: "virtual field" }).trimEnd().split("\r\n");
  assert.equal(lines[0], "time [UTC],twin [kN],lower end of 95 % interval [kN],upper end of 95 % interval [kN],"
    + "simulation alone [kN],measured [kN],origin");
  assert.deepEqual(lines.slice(1), [
    "1970-01-01T00:00:00.000Z,2,1,3,1.8,,virtual field",
    "1970-01-01T00:01:00.000Z,2.1,,,2,,virtual field",
    "1970-01-01T00:02:00.000Z,,,,,2.5,virtual field", // the gap before it is no row
  ]);
});

test("its heads follow the chosen units, and a comma within a cell stays within", () => {
  choose("kN", "tf");
  const [head, first] = csvOf(rows, { unit: "kN", origin: 'measured, by "us"' }).split("\r\n");
  assert.match(head, /twin \[tf\]/);
  assert.ok(first.endsWith(',"measured, by ""us"""'));
  assert.match(csvOf(rows, { unit: "%", origin: "" }), /twin \[%\]/);
  choose("kN", "kN");
});
