import assert from "node:assert/strict";
import { test } from "node:test";

import {
  bearing, beyond, compass, day, fixed, half, moment, percent, plain, span, spoken, time, titled, turned, unbroken,
  withUnit,
} from "../../src/panels/format.js";

test("a number that is not known is a dash and has no unit", () => {
  for (const nothing of [null, undefined, NaN, Infinity]) {
    assert.equal(fixed(nothing), "–");
    assert.equal(withUnit(nothing, "kN"), "–");
    assert.equal(percent(nothing), "–");
    assert.equal(bearing(nothing), "–");
  }
});

test("a number has its decimals and a true minus", () => {
  assert.equal(fixed(-1.26), "−1.3");
  assert.equal(fixed(-0.04), "0.0");
  assert.equal(withUnit(2, "m", 2), "2.00 m");
});

test("an interval is shown by half its width, and not at all where an end is missing", () => {
  assert.equal(half({ lower: 1, upper: 4 }), "± 1.5");
  assert.equal(half({ lower: null, upper: 4 }), "");
  assert.equal(half(undefined), "");
  assert.equal(half({ lower: 1, upper: 1.02 }), "± <0.1");
});

test("directions go round", () => {
  assert.equal(bearing(359.7), "000°");
  assert.equal(bearing(-90), "270°");
  assert.equal(compass(359), "N");
  assert.equal(compass(248), "WSW");
  assert.equal(spoken(340), "north");
  assert.equal(turned(-10), 350);
});

test("a length of time has the largest unit that says something", () => {
  assert.deepEqual([0, 89, 600, 7200, 5 * 86400].map(span), ["0 s", "89 s", "10 min", "2 h", "5 days"]);
  assert.equal(span(null), "–");
});

test("times are UTC, as in ISO 8601", () => {
  const t = Date.UTC(2026, 2, 1, 4, 5, 6);
  assert.equal(day(t), "2026-03-01");
  assert.equal(time(t, true), "04:05:06");
  assert.equal(moment(t), "2026-03-01 04:05 UTC");
});

test("names lose their hyphens", () => {
  assert.equal(plain("depth-2"), "depth 2");
  assert.equal(titled("bridle-12"), "Bridle 12");
});

test("extrapolating is not written twice", () => {
  assert.equal(beyond("Extrapolating: level 1 ends at 1 m/s."), "Level 1 ends at 1 m/s.");
  assert.match(beyond(""), /beyond what the twin has learned/);
});

test("no line ends between a number and its unit, and words stay as they are", () => {
  assert.equal(unbroken("at 45 %, 131 kN; 3 more, 2 mooring lines in 10 min"),
    "at 45\u00a0%, 131\u00a0kN; 3 more, 2 mooring lines in 10\u00a0min");
});
