// A line's panel and the ranking: nothing is shown that the service does not say.

import assert from "node:assert/strict";
import { test } from "node:test";

import { topologyOf } from "../../dev/cage.js";
import { partedOf, stateOf } from "../../dev/state.js";
import { kindsOf, linesOf, selectionOf } from "../../src/lines.js";
import { nowRows, partedRows, small, wearNote, wearRows, windowNote, windowRows } from "../../src/panels/line-rows.js";
import { otherRows } from "../../src/panels/load-rows.js";
import { Parting } from "../../src/panels/parting.js";
import { apart, around } from "../../src/panels/rose-shape.js";

const topology = topologyOf("calm", 1);
const line = { name: "anchor-2", kind: "anchor line", level: 1, mean_kn: 60, std_kn: 5,
  maximum_3h_kn: { mean: 81, lower: null, upper: null }, utilisation: null };
const state = { valid: true, lines: [line], bridles: [], lines_reason: "" };
const withLine = (changes) => ({ ...state, lines: [{ ...line, ...changes }] });
const values = (rows) => rows.map(([, value]) => value);

test("all kinds of lines can be chosen, each by its own name", () => {
  assert.deepEqual(kindsOf(topology), ["bridle", "frame line", "anchor line", "buoy line"]);
  assert.equal(linesOf(topology).length, 28);
  assert.deepEqual(selectionOf(topology, "bridle-3"), { bridle: "bridle-3" });
  assert.deepEqual(selectionOf(topology, "anchor-3"), { line: "anchor-3" });
  assert.deepEqual(kindsOf({ bridle_names: ["bridle-1"] }), ["bridle"]); // of an older service
});

test("frame lines are on the rose at their sides, and no two anchor lines fall on one another", () => {
  const directions = (kind) => around(topology, kind).map(({ direction }) => Math.round(direction));
  assert.deepEqual(directions("frame line"), [0, 270, 180, 90]);
  const sorted = directions("anchor line").sort((a, b) => a - b);
  assert.ok(sorted.every((one, k) => k === 0 || one - sorted[k - 1] > 14), sorted.join());
});

test("directions are apart by the shorter way round", () => {
  assert.deepEqual([apart(350, 10), apart(10, 350), apart(90, 270), apart(5, 5)], [20, 20, 180, 0]);
});

test("a row on the rose has lengths on the scale of forces, and null where nothing is known", () => {
  const scale = (kn) => (Number.isFinite(kn) ? kn / 100 : null);
  const [known, unknown] = otherRows(["anchor-2", "anchor-3"], state, scale, "red");
  assert.deepEqual([known.mean, known.maximum, known.maximumLower], [0.6, 0.81, null]);
  assert.deepEqual([unknown.mean, unknown.maximum], [null, null]);
});

test("the panel has the window's statistics, with an interval where there is one", () => {
  assert.deepEqual(values(windowRows("anchor-2", state)), ["60.0 kN", "5.0 kN", "81.0 kN"]);
  const interval = withLine({ level: 2, utilisation: 0.4, maximum_3h_kn: { mean: 81, lower: 75, upper: 87 } });
  assert.deepEqual(values(windowRows("anchor-2", interval)), ["60.0 kN", "5.0 kN", "81.0 kN ± 6.0"]);
  assert.match(windowNote("anchor-2", state), /no interval/);
  assert.equal(windowNote("anchor-2", interval), "");
  const byOthers = withLine({ maximum_3h_kn: { mean: 81, lower: 60, upper: 102 } });
  assert.deepEqual(values(windowRows("anchor-2", byOthers)), ["60.0 kN", "5.0 kN", "81.0 kN ± 21.0"]);
  assert.match(windowNote("anchor-2", byOthers), /off at the shackles/);
});

test("without waves the panel gives the reason, and the mean's spread where that is known", () => {
  const nothing = { mean: null, lower: null, upper: null };
  const calm = { ...withLine({ std_kn: null, maximum_3h_kn: nothing, mean_spread_kn: 4 }), lines_reason: "Hs is not known." };
  assert.deepEqual(values(windowRows("anchor-2", calm)), ["60.0 kN", "± 4.0 kN", "–", "–"]);
  assert.match(windowNote("anchor-2", calm), /Hs is not known/);
  assert.match(windowNote("anchor-2", { ...state, lines_reason: "Extrapolated." }), /^Extrapolated\. Simulation alone/);
  assert.match(windowNote("anchor-2", { ...state, tp_assumed: true }), /period is not known/);
});

test("damage that the service does not state has no row", () => {
  assert.deepEqual([wearRows("anchor-2", state), wearNote("anchor-2", state)], [[], ""]);
  const worn = withLine({ damage_per_year: 0.0213, damage: 0.00034, damage_since: "2020-01-18T06:00:00Z",
    damage_valid_h: 30, damage_missing_h: 1.5 });
  assert.deepEqual(values(wearRows("anchor-2", worn)), ["2.1 % of its life", "0.034 % of its life"]);
  assert.equal(wearNote("anchor-2", worn), "Since 2020-01-18: 30 h counted, 1.5 h without an answer.");
  assert.deepEqual([0, 1e-9, 0.5, 3].map(small), ["0 %", "<0.001 %", "50 %", "300 %"]);
});

test("a bridle's load now is there beside its statistics", () => {
  const bridles = [{ name: "bridle-1", level: 2, tension_kn: { mean: 50, lower: 45, upper: 55 }, measured_by: "shackle-1", measured_kn: 52 }];
  assert.deepEqual(values(nowRows("bridle-1", { bridles })), ["50.0 kN ± 5.0", "52.0 kN"]);
  assert.deepEqual(nowRows("anchor-2", { bridles }), []);
});

test("without a line the panel names which others bear most, and says where that is not known", () => {
  const parted = { largest_mean: { line: "bridle-2", kn: 90 }, largest_maximum_3h: null, utilisation: null,
    second_would_part: null, volume_share: 0.9, clearance_m: null, drift_m: 4.25 };
  assert.deepEqual(values(partedRows(parted)), ["90.0 kN, bridle 2", "–", "not known", "90 %", "4.3 m"]);
  assert.deepEqual(partedRows(undefined), []);
});

/** A model that answers as told, and notes what was asked. */
function modelOf(answers) {
  const heard = new Map();
  return { view: { mode: "live", t: 0 }, cageName: "ace", asked: [],
    on(name, fn) { heard.set(name, fn); },
    show(view) { this.view = view; heard.get("view")(view); },
    async call(_, path) { this.asked.push(path); return answers(path); } };
}

test("the service is asked what would be without a line once, and anew for another time", async () => {
  const model = modelOf(() => partedOf({ name: "ace" }, 0, { current_speed_m_s: 0.5, current_to_deg: 90, hs_m: 1, wave_from_deg: 0 }));
  const parting = new Parting(model);
  await parting.ask();
  await parting.ask();
  assert.deepEqual(model.asked, ["cages/ace/what-if-parted"]);
  assert.equal(parting.without("bridle-1").parted, "bridle-1");
  model.show({ mode: "live", t: 9 });
  assert.ok(parting.answer);
  model.show({ mode: "past", t: 3600e3 });
  assert.equal(parting.answer, null); // of another time
  await parting.ask();
  assert.equal(model.asked[1], "cages/ace/what-if-parted?at=1970-01-01T01%3A00%3A00.000Z");
  model.show({ mode: "whatif", t: 0 });
  await parting.ask();
  assert.equal(model.asked.length, 2);
});

test("a service that does not know the question is asked no more", async () => {
  const model = modelOf(() => { throw Object.assign(new Error("There is nothing here."), { status: 404 }); });
  const parting = new Parting(model);
  await parting.ask();
  await parting.ask({ anew: true });
  assert.deepEqual([parting.absent, model.asked.length], [true, 1]);
});

test("the stand-in's silent cage has a reason instead of lines", () => {
  const { lines, reason } = partedOf({ name: "silent", trouble: "silent" }, 0, { current_speed_m_s: 0.5, current_to_deg: 90 });
  assert.deepEqual(lines, []);
  assert.match(reason, /silent/);
  assert.ok(stateOf({ name: "calm" }, 0, { current_speed_m_s: 0.5, current_to_deg: 90, hs_m: 1 }, []).lines.length);
});
