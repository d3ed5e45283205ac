import assert from "node:assert/strict";
import { test } from "node:test";

import { append, columnsOf, trim } from "../../src/panels/columns.js";
import { joined, nearest, quantities, rowsOf, widened } from "../../src/panels/plotted.js";
import { largestOver, marksOf, runs } from "../../src/panels/overview-rows.js";

const at = (s) => new Date(1000 * s).toISOString();
const series = (mean) => ({
  unit: "kN", level: 2, low_fidelity: mean.map((one) => one + 1), mean: [...mean],
  lower: mean.map((one) => one - 2), upper: mean.map((one) => one + 2),
});
const history = () => ({
  t: [at(0), at(60)], current_speed_m_s: [0.1, 0.2], current_to_deg: [90, 91],
  volume_fraction: [1, 0.9], bridles: { "bridle-1": series([10, 20]) },
  sensors: { "depth-1": series([5, 6]) }, measured: { "depth-1": { t: [at(10)], value: [5.5] } },
});
const state = (s, changes = {}) => ({
  t: at(s), valid: true, water: { current_speed_m_s: 0.3, current_to_deg: 92 }, volume_fraction: 0.8,
  bridles: [{ name: "bridle-1", low_fidelity_kn: 31, tension_kn: { mean: 30, lower: 28, upper: 32 } }],
  sensors: [{ name: "depth-1", low_fidelity: 8, mean: 7, lower: 5, upper: 9, measured: 7.2, measured_age_s: 5 }],
  amended: [], ...changes,
});

test("a state goes on where the history ends", () => {
  const columns = columnsOf(history());
  append(columns, state(120), 30);
  assert.deepEqual(columns.t, [0, 60, 120]);
  assert.deepEqual(columns.bridles["bridle-1"].mean, [10, 20, 30]);
  assert.deepEqual(columns.measured["depth-1"], { t: [10, 115], value: [5.5, 7.2] });
});

test("states that come thick and fast take each other's place", () => {
  const columns = columnsOf(history());
  for (const s of [120, 122, 124]) append(columns, state(s), 100);
  assert.deepEqual(columns.t, [0, 60, 124]);
  assert.equal(columns.speed.length, 3);
});

test("a state that was already there changes nothing", () => {
  const columns = columnsOf(history());
  append(columns, state(60), 30);
  assert.deepEqual(columns.t, [0, 60]);
});

test("without valid input the curves have a hole, not a number", () => {
  const columns = columnsOf(history());
  const nothing = { mean: null, lower: null, upper: null };
  append(columns, state(120, {
    valid: false, volume_fraction: null,
    bridles: [{ name: "bridle-1", low_fidelity_kn: null, tension_kn: nothing }],
  }), 30);
  assert.equal(columns.speed[2], null);
  assert.equal(columns.bridles["bridle-1"].mean[2], null);
});

test("a reading counts once however often it comes, and a spike is taken back", () => {
  const columns = columnsOf(history());
  append(columns, state(120), 30);
  const again = state(122).sensors.map((one) => ({ ...one, measured_age_s: 7 }));
  append(columns, state(122, { sensors: again }), 30);
  assert.equal(columns.measured["depth-1"].t.length, 2);
  const amended = [{ stream: "depth-1", t: at(115), flag: 4 }];
  append(columns, state(124, { amended, sensors: [] }), 30);
  assert.deepEqual(columns.measured["depth-1"], { t: [10], value: [5.5] });
});

test("what is too old is forgotten in all columns alike", () => {
  const columns = columnsOf(history());
  trim(columns, 30);
  assert.deepEqual(columns.t, [60]);
  assert.deepEqual(columns.bridles["bridle-1"].upper, [22]);
  assert.deepEqual(columns.measured["depth-1"].t, []);
});

test("the twin's rows and the readings share one set of times", () => {
  const columns = columnsOf(history());
  const [t, lower, upper, measured, low, mean] =
    joined(rowsOf(columns, { key: "sensor:depth-1", name: "depth-1", sensor: "depth-1" }), 1000);
  assert.deepEqual(t, [0, 10, 60]);
  assert.deepEqual(mean, [5, undefined, 6]);
  assert.deepEqual(measured, [undefined, 5.5, undefined]);
  assert.deepEqual([lower[0], upper[0], low[0]], [3, 7, 6]);
});

test("what has no interval is drawn without one", () => {
  const nothing = { level: 1, lower: [null, null], upper: [null, null] };
  const bridles = { "bridle-1": { ...series([10, 20]), ...nothing } };
  const columns = columnsOf({ ...history(), bridles });
  const { lower, upper, mean } =
    rowsOf(columns, { key: "bridle:bridle-1", name: "bridle-1", sensor: null });
  assert.deepEqual([lower, upper, mean], [[null, null], [null, null], [10, 20]]);
});

test("a curve is not drawn through a time for which the twin has no answer", () => {
  const columns = columnsOf(history());
  const [t, , , , , mean] =
    joined(rowsOf(columns, { key: "bridle:bridle-1", name: "bridle-1", sensor: null }), 30);
  assert.deepEqual(t, [0, 30, 60]);
  assert.deepEqual(mean, [10, null, 20]);
});

test("rows stay in time order when a reading lies in a gap", () => {
  const rows = { t: [0, 100], lower: [0, 0], upper: [0, 0], low: [0, 0], mean: [1, 2],
    measured: { t: [10, 50, 90], value: [1, 1, 1] } };
  const [t] = joined(rows, 30);
  assert.deepEqual(t, [0, 10, 30, 50, 90, 100]);
});

test("the volume is charted in per cent", () => {
  const { mean } = rowsOf(columnsOf(history()), { key: "cage:volume", name: "volume", sensor: null });
  assert.deepEqual(mean, [100, 90]);
});

test("every sensor and bridle can be charted", () => {
  const topology = {
    shackles: [{ name: "shackle-1", bridle: 1 }], depth_sensors: [{ name: "depth-1", node: 0 }],
    rest_position_m: [[0, 0, -7]], bridle_names: ["bridle-1", "bridle-2"], bridle_capacity_kn: [160, 160],
  };
  const all = quantities(topology);
  assert.equal(all.length, 6);
  assert.equal(all.find(({ name }) => name === "bridle-2").sensor, "shackle-1");
  assert.equal(all[0].place, "rests at 7.0 m");
});

test("the nearest time is found", () => {
  assert.equal(nearest([], 1), -1);
  assert.deepEqual([-5, 4, 6, 99].map((t) => nearest([0, 5, 10], t)), [0, 1, 1, 2]);
});

test("the overview has the largest share, and none where a bridle is not known", () => {
  const columns = { t: [0, 1], bridles: { a: { mean: [80, 40] }, b: { mean: [20, null] } } };
  assert.deepEqual(largestOver(columns, [160, 100]), [0.5, null]);
});

test("the overview counts what a shackle measured, until that is too old", () => {
  const columns = { t: [0, 600, 1600], bridles: { a: { mean: [16, 16, 16] } },
    measured: { "shackle-1": { t: [500], value: [80] } } };
  assert.deepEqual(largestOver(columns, [160], [{ name: "shackle-1", bridle: 0 }]), [0.1, 0.5, 0.1]);
});

test("no axis of tensions or depths reaches below zero, unless a reading does", () => {
  assert.equal(widened(0, 10)[0], 0);
  assert.equal(widened(0.1, 10)[0], 0);
  assert.ok(widened(14, 15)[0] > 13.5);
  assert.ok(widened(-0.2, 1)[0] < -0.2);
});

test("the overview is not drawn through a gap", () => {
  assert.deepEqual(runs([0, 1, 2, 9], [1, null, 2, 3], 5), [[[0, 1]], [[2, 2]], [[9, 3]]]);
});

test("the worst mark is painted last", () => {
  const lines = ["a", "b"].map((alarm) => ({ alarm, action: "raised", t: at(1) }));
  const marks = marksOf([...lines, { alarm: "a", action: "cleared", t: at(2) }],
    [{ id: "a", severity: 900 }, { id: "b", severity: 100 }]);
  assert.deepEqual(marks.map(({ rank }) => rank), ["note", "critical"]);
});
