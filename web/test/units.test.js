// What the reader chose to see numbers and times in; the service's own are SI and UTC.

import assert from "node:assert/strict";
import { afterEach, test } from "node:test";

const kept = new Map();
globalThis.localStorage = { getItem: (key) => kept.get(key) ?? null, setItem: (key, value) => kept.set(key, value) };
const { CHOICES, choose, onUnits, setSiteZone, shown, unitName, zone } = await import("../src/units.js");
const { amount, day, half, moment, time, withUnit } = await import("../src/panels/format.js");
const { change } = await import("../src/panels/sea-wanted.js");

afterEach(() => CHOICES.forEach(([name, [first]]) => choose(name, first)));
const NIGHT = Date.UTC(2020, 0, 18, 23, 30); // half past midnight in Norway

test("without a choice all is as the service has it", () => {
  assert.deepEqual([withUnit(98.0665, "kN"), withUnit(0.5, "m/s", 2), withUnit(14.2, "m"), withUnit(6, "s")],
    ["98.1 kN", "0.50 m/s", "14.2 m", "6.0 s"]);
  assert.equal(moment(NIGHT), "2020-01-18 23:30 UTC");
});

test("numbers follow the choice, with as many figures as they need", () => {
  for (const [unit, choice] of [["kN", "tf"], ["m/s", "kn"], ["m", "ft"]]) choose(unit, choice);
  assert.deepEqual([withUnit(98.0665, "kN"), withUnit(1.852, "m/s", 2), withUnit(3.048, "m", 2)],
    ["10.00 tf", "3.60 kn", "10.0 ft"]);
  assert.equal(amount(null, "kN"), "–");
  assert.equal(withUnit(6, "s"), "6.0 s");
  assert.equal(half({ mean: 98.0665, lower: 78.4532, upper: 117.6798 }, "kN"), "± 2.00");
  assert.equal(change(0, 9.80665, "kN", 1), "+1.00");
  assert.deepEqual([shown(null, "kN"), unitName("%")], [null, "%"]);
});

test("times follow the clock of a named zone, in summer and in winter", () => {
  setSiteZone("Europe/Oslo");
  choose("clock", "site");
  assert.equal(moment(NIGHT), "2020-01-19 00:30 GMT+1");
  assert.equal(`${day(NIGHT)} ${time(Date.UTC(2020, 6, 1, 12), true)}`, "2020-01-19 14:00:00");
  setSiteZone(undefined); // another cage, whose zone is not known
  assert.equal(zone(), "UTC");
});

test("a choice is kept, and those who show numbers hear of it", () => {
  const heard = [];
  const stop = onUnits((name) => heard.push(name));
  choose("kN", "tf");
  stop();
  assert.deepEqual(heard, ["kN"]);
  assert.equal(JSON.parse(kept.get("seacage-units")).kN, "tf");
});
