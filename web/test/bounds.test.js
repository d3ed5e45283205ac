import assert from "node:assert/strict";
import { test } from "node:test";

import { possible, possibleSeries } from "../src/bounds.js";
import { half } from "../src/panels/format.js";

const state = {
  bridles: [{ name: "bridle-1", low_fidelity_kn: -0.2, tension_kn: { mean: 1.2, lower: -2.8, upper: 5.2 } }],
  sensors: [{ name: "depth-1", unit: "m", low_fidelity: 0.1, mean: 0.2, lower: -0.3, upper: 0.7, measured: -0.1 }],
};

test("no interval reaches below zero tension or above the surface", () => {
  const { bridles: [bridle], sensors: [sensor] } = possible(state);
  assert.deepEqual(bridle.tension_kn, { mean: 1.2, lower: 0, upper: 5.2 });
  assert.equal(bridle.low_fidelity_kn, 0);
  assert.deepEqual([sensor.lower, sensor.upper], [0, 0.7]);
  assert.equal(sensor.measured, -0.1, "what was read stays as it was read");
});

test("nor does one of the history, and what is not known stays unknown", () => {
  const series = possibleSeries({ level: 2, mean: [1, null], lower: [-1, null], upper: [2, null], low_fidelity: [1, 1] });
  assert.deepEqual([series.lower, series.mean], [[0, null], [1, null]]);
  const unknown = { bridles: [{ tension_kn: { mean: 3, lower: null, upper: null } }] };
  assert.deepEqual(possible(unknown).bridles[0].tension_kn, { mean: 3, lower: null, upper: null });
});

test("an interval that is cut off is shown by its ends, for half its width would mislead", () => {
  assert.equal(half({ mean: 1.2, lower: 0, upper: 5.2 }), "(0.0 to 5.2)");
  assert.equal(half({ mean: 3, lower: 1, upper: 5 }), "± 2.0");
});
