import assert from "node:assert/strict";
import { test } from "node:test";

import { judged } from "../../src/panels/verdict.js";

const state = (changes = {}) => ({
  valid: true, in_domain: true, reason: "", age_s: 30, alarms: [], silent: [], ...changes,
});
const alarm = (changes = {}) => ({
  id: "load.bridle-3", severity: 850, title: "Load on bridle-3", active: true, acknowledged: false,
  shelved: false, ...changes,
});
const now = (changes) => judged({
  connection: "live", live: { t: 0, stale: false, ageS: 30, state: state(changes) },
});

test("a quiet cage is well", () => {
  assert.equal(now().headline, "All well");
  assert.equal(now().kind, "well");
});

test("a silent sensor is told even when all is well", () => {
  assert.match(now({ silent: ["depth-2"] }).detail, /depth 2/);
});

test("the worst alarm gives the colour and the words", () => {
  const alarms = [alarm({ severity: 550, title: "depth-2 drifts" }), alarm()];
  const { kind, headline, detail } = now({ alarms });
  assert.equal(kind, "critical");
  assert.equal(headline, "2 alarms");
  assert.equal(detail, "Load on bridle-3 and 1 more.");
});

test("a shelved alarm alarms nobody", () => {
  assert.equal(now({ alarms: [alarm({ shelved: true })] }).kind, "well");
});

test("an alarm that has cleared counts until somebody has seen it", () => {
  assert.equal(now({ alarms: [alarm({ active: false })] }).headline, "1 alarm");
  assert.equal(now({ alarms: [alarm({ active: false, acknowledged: true })] }).kind, "well");
});

test("without valid input nothing is well, and the reason is given", () => {
  const { kind, headline, detail } = now({ valid: false, reason: "buoy-1 is silent.", alarms: [alarm()] });
  assert.equal(headline, "No valid input");
  assert.equal(kind, "critical");
  assert.match(detail, /buoy-1 is silent\. No loads are shown\. 1 alarm\./);
});

test("a cage that never heard anything waits for a first reading", () => {
  assert.equal(now({ valid: false, age_s: null }).headline, "Waiting for a first reading");
});

test("beyond what was learned is said, and alarms come first", () => {
  assert.equal(now({ in_domain: false }).headline, "Extrapolating");
  const both = now({ in_domain: false, alarms: [alarm()] });
  assert.equal(both.headline, "1 alarm");
  assert.match(both.detail, /extrapolating/);
  const said = now({ in_domain: false, alarms: [alarm({ id: "domain.input", title: "Water beyond" })] });
  assert.equal(said.detail, "Water beyond.");
});

test("an alarm that went and waits to be seen is not told as if it were still so", () => {
  const gone = alarm({ active: false, acknowledged: false, title: "Bridle 3 is heavily loaded" });
  assert.match(now({ alarms: [gone] }).detail, /^Bridle 3 is heavily loaded, over by now\.$/);
});

test("a lost connection is never well, whatever came last", () => {
  const { kind, detail } = judged({
    connection: "lost", live: { t: Date.UTC(2026, 0, 2, 3, 4), stale: true, ageS: 1, state: state() },
  });
  assert.equal(kind, "lost");
  assert.equal(detail, "What is shown is of 2026-01-02 03:04 UTC.");
});

test("an input that has grown too old on the page is not well", () => {
  const live = { t: 0, stale: true, ageS: 7200, state: state() };
  assert.equal(judged({ connection: "live", live }).headline, "Input too old");
});
