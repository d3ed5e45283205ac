import assert from "node:assert/strict";
import { test } from "node:test";

import { byNeed, summed, tileVerdict } from "../../src/panels/farm-tile.js";
import { heaviest } from "../../src/panels/line-table.js";
import { largest, loadRows } from "../../src/panels/load-rows.js";
import { INNER, OUTER, azimuths, polar, radius } from "../../src/panels/rose-shape.js";
import { ringsOf, scaleFor } from "../../src/panels/scale.js";
import { change } from "../../src/panels/sea-wanted.js";
import { largestKnown } from "../../src/known-load.js";
import { loadWords } from "../../src/panels/now.js";

const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-9, `${a} is not ${b}`);

test("north is up and east is to the right on the rose", () => {
  const [[north, up], [east, level]] = [polar(0, 10), polar(90, 10)];
  near(north, 0);
  near(up, -10);
  near(east, 10);
  near(level, 0);
});

test("a bridle stands where it leaves the collar, x east and y north", () => {
  const [a, b] = azimuths({ bridle_nodes: [0, 1], rest_position_m: [[1, 0, 0], [-1, 0, 0]] });
  near(a, 90);
  near(b, 270);
});

test("a load's length begins at the middle ring and ends just outside the scale", () => {
  assert.equal(radius(0, 1), INNER);
  assert.equal(radius(1, 1), OUTER);
  assert.ok(radius(7, 1) < OUTER + 10);
});

test("the scale holds the largest load and does not jump at its edge", () => {
  assert.equal(scaleFor(0.31), 0.5);
  assert.equal(scaleFor(0.29, 0.5), 0.5);
  assert.equal(scaleFor(0.2, 0.5), 0.3);
  assert.equal(scaleFor(99), 5);
});

test("the last ring is the end of the scale", () => {
  for (const end of [0.1, 0.75, 1, 5]) near(ringsOf(end).at(-1), end);
});

const topology = { bridle_capacity_kn: [100, 200], shackles: [{ name: "shackle-1", bridle: 1 }] };
const state = {
  valid: true, alarms: [{ id: "load.bridle-1", severity: 900, active: true, acknowledged: false }],
  sensors: [{ name: "shackle-1", measured: 60 }],
  bridles: [
    { name: "bridle-1", level: 1, utilisation: 0.5, low_fidelity_kn: 50, tension_kn: { mean: 50, lower: 40, upper: 60 } },
    { name: "bridle-2", level: 2, utilisation: 0.25, low_fidelity_kn: 40, tension_kn: { mean: 50, lower: 45, upper: 55 },
      measured_kn: 60, measured_utilisation: 0.3, measured_by: "shackle-1" },
  ],
};

test("a row says what twin, simulation and shackle say of a bridle", () => {
  const [one, two] = loadRows(topology, state);
  assert.deepEqual([one.mean, one.measured, one.rank], [0.5, null, "critical"]);
  assert.deepEqual([two.lower, two.upper, two.measured, two.measuredKn], [0.225, 0.275, 0.3, 60]);
  assert.equal(largest([one, two]), 0.6);
});

test("the largest load expected in waves is on the rose and in its scale", () => {
  const lines = [{ name: "bridle-2", maximum_3h_kn: { mean: 140, lower: 120, upper: 170 } }];
  const [one, two] = loadRows(topology, { ...state, lines });
  assert.deepEqual([one.maximum, two.maximum, two.maximumLower, two.maximumUpper], [null, 0.7, 0.6, 0.85]);
  assert.equal(largest([one, two]), 0.85);
});

test("the summary of all lines names the one that bears most, or why none is known", () => {
  const line = (name, mean) => ({ name, maximum_3h_kn: { mean } });
  assert.match(heaviest([line("bridle-1", 40), line("anchor-3", 90)], {}), /anchor 3, 90\.0 kN/);
  const bridle = { ...line("bridle-1", 40), utilisation: 0.25 };
  assert.match(heaviest([bridle, line("anchor-3", 90)], {}), /bridle 1, 40\.0 kN .* 25 % of capacity/);
  assert.match(heaviest([line("bridle-1", null)], { lines_reason: "Hs is not known." }), /Hs is not known/);
});

test("a bridle has the interval that the state gives, at level 1 too, and none where it has none", () => {
  const bridles = state.bridles.map((one) => ({ ...one, tension_kn: { mean: 50, lower: null, upper: null } }));
  const [known, none] = [state, { ...state, bridles }].map((one) => loadRows(topology, one)[0]);
  assert.deepEqual([known.lower, known.upper], [0.4, 0.6]);
  assert.deepEqual([none.interval, none.lower, none.upper], [null, null, null]);
});

test("without valid input a row has no number", () => {
  const nothing = { mean: null, lower: null, upper: null };
  const bridles = state.bridles.map((one) => ({ ...one, utilisation: null, low_fidelity_kn: null, tension_kn: nothing }));
  const [one] = loadRows(topology, { ...state, bridles });
  assert.deepEqual([one.mean, one.lower, one.upper, one.low], [null, null, null, null]);
  assert.equal(largestKnown({ ...state, bridles: bridles.slice(0, 1) }), null);
});

test("the largest load is the one nearest its own capacity", () => {
  assert.equal(largestKnown(state).name, "bridle-1");
});

const read = (share, rest = {}) => ({ ...state, ...rest, bridles: state.bridles.map((one) =>
  (one.measured_by ? { ...one, measured_kn: 200 * share, measured_utilisation: share } : one)) });

test("a shackle that reads more than any prediction gives the largest load, and is named", () => {
  const top = largestKnown(read(0.6));
  assert.deepEqual([top.name, top.kn, top.by], ["bridle-2", 120, "shackle-1"]);
  assert.equal(loadWords(top), "bridle 2, 60 % of capacity, measured by shackle 1");
  assert.match(loadWords(largestKnown(state)), /simulated$/);
});

test("a measured load is known where nothing is predicted for want of input", () => {
  const nothing = { mean: null, lower: null, upper: null };
  const { bridles } = read(0.6);
  const unknown = bridles.map((one) => ({ ...one, utilisation: null, tension_kn: nothing }));
  assert.equal(largestKnown({ ...state, valid: false, bridles: unknown }).kn, 120);
});

test("a shackle that reads irregularly has no say in the largest load, as in the load's alarm", () => {
  const alarms = [{ id: "irregular.shackle-1", severity: 500, active: true }];
  assert.equal(largestKnown(read(0.6, { alarms })).name, "bridle-1");
});

test("the rose, the table and the bar show the larger of what is known of a bridle", () => {
  const [one, two] = loadRows(topology, read(0.6));
  assert.deepEqual([one.top, two.top, two.topKn], [0.5, 0.6, 120]);
});

test("a silent shackle outlines itself and not its bridle", () => {
  const alarms = [{ id: "silent.shackle-1", severity: 500, active: true }];
  assert.equal(loadRows(topology, { ...state, alarms })[1].rank, null);
  const load = [{ id: "load.bridle-2", severity: 700, active: true }];
  assert.equal(loadRows(topology, { ...state, alarms: load })[1].rank, "warning");
});

test("a bridle of level 2 without an interval shows none, and says why", () => {
  const bridles = state.bridles.map((one) => ({ ...one, in_domain: false, interval_reason: "No sensor.",
    tension_kn: { ...one.tension_kn, lower: null, upper: null } }));
  const [, two] = loadRows(topology, { ...state, bridles });
  assert.deepEqual([two.interval, two.lower, two.reason, two.within], [null, null, "No sensor.", false]);
});

test("a change has its sign, and none is shown where a side is not known", () => {
  assert.equal(change(1, 3.04, "kN", 1), "+2.0");
  assert.equal(change(3, 1, "kN", 1), "−2.0");
  assert.equal(change(1, 1.01, "kN", 1), "no change");
  assert.equal(change(null, 1, "kN", 1), "");
});

test("a farm is summed up in words", () => {
  const [well, bad] = [{ waiting: 0, valid: true, in_domain: true }, { waiting: 0, valid: false }];
  const sums = [[well], [bad], [well, well], [bad, bad], [well, bad, well]].map(summed);
  assert.deepEqual(sums, ["1 cage, well", "1 cage, not well", "2 cages, all well",
    "2 cages, none well", "3 cages, 2 of them well"]);
});

test("the cage in the greatest need comes first on the farm", () => {
  const cage = (name, changes = {}) => ({ name, waiting: 0, valid: true, in_domain: true, ...changes });
  const concerns = [{ kind: "volume", title: "Volume low", message: "The net holds 70 %." }];
  const cages = [cage("b"), cage("a"), cage("odd", { in_domain: false }), cage("thin", { concerns }),
    cage("mute", { valid: false }), cage("bad", { waiting: 2, worst_severity: 900, worst_title: "Load" })];
  assert.deepEqual(byNeed(cages).map(({ name }) => name), ["bad", "mute", "odd", "thin", "a", "b"]);
  assert.deepEqual(tileVerdict(cages[3]), { kind: "caution", icon: "caution", words: "Volume low",
    detail: "The net holds 70 %." });
  assert.deepEqual(tileVerdict(cages[5]),
    { kind: "critical", icon: "critical", words: "2 alarms", detail: "Load" });
});
