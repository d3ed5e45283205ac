import assert from "node:assert/strict";
import { test } from "node:test";

import { verdict } from "../../src/panels/verdict.js";

const state = (changes = {}) => ({
  valid: true, in_domain: true, reason: "", age_s: 30, alarms: [], silent: [], ...changes,
});
const alarm = (changes = {}) => ({
  id: "load.bridle-3", severity: 850, title: "Load on bridle-3", active: true, acknowledged: false,
  shelved: false, ...changes,
});
const now = (changes) => verdict({
  connection: "live", live: { t: 0, stale: false, ageS: 30, state: state(changes) },
});

test("a quiet cage is well", () => {
  assert.equal(now().headline, "All well");
  assert.equal(now().kind, "well");
});

test("with a silent sensor all is not well, and it is named", () => {
  const { headline, detail } = now({ silent: ["depth-2"] });
  assert.equal(headline, "Partly measured");
  assert.match(detail, /depth 2/);
});

const concern = (kind, title, message) => ({ kind, title, message });
const VOLUME = concern("volume", "Volume low", "The net holds 71 % of its volume in still water; 80 % is the limit.");

test("a net that has lost volume is not well, and the limit is shown", () => {
  const { kind, headline, detail } = now({ concerns: [VOLUME] });
  assert.deepEqual([kind, headline], ["caution", "Volume low"]);
  assert.match(detail, /80 % is the limit/);
});

test("a load at its alarm's limit has the alarm's colour before the alarm is raised", () => {
  const load = concern("load", "Load at its limit", "Bridle 8 bears 82 % of its capacity, measured by shackle 2.");
  const { kind, headline, detail } = now({ concerns: [load, VOLUME] });
  assert.deepEqual([kind, headline], ["warning", "Load at its limit"]);
  assert.match(detail, /^Bridle 8 bears 82 %.*measured by shackle 2\. The net holds/);
});

test("where nothing is measured all is not well", () => {
  const nothing = concern("measured", "Nothing measured", "No sensor has given a valid reading.");
  assert.equal(now({ concerns: [nothing] }).headline, "Nothing measured");
  assert.equal(now({ concerns: [nothing], in_domain: false }).headline, "Extrapolating");
  assert.match(now({ concerns: [nothing], in_domain: false }).detail, /No sensor/);
});

test("an active alarm comes before a worse one that has cleared", () => {
  const gone = alarm({ id: "net.net", severity: 900, title: "The net may be torn", active: false });
  const { kind, detail } = now({ alarms: [gone, alarm({ severity: 600 })] });
  assert.equal(kind, "warning");
  assert.match(detail, /^Load on bridle-3 and 1 more/);
});

test("the worst alarm gives the colour and the words", () => {
  const alarms = [alarm({ id: "irregular.depth-2", severity: 550, title: "depth-2 drifts" }), alarm()];
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
  assert.match(detail, /buoy-1 is silent\. Nothing is predicted\. 1 alarm\./);
});

test("a cage that never received anything waits for a first reading", () => {
  assert.equal(now({ valid: false, age_s: null }).headline, "Waiting for a first reading");
});

test("extrapolation is shown, and alarms come first", () => {
  assert.equal(now({ in_domain: false }).headline, "Extrapolating");
  const both = now({ in_domain: false, alarms: [alarm()] });
  assert.equal(both.headline, "1 alarm");
  assert.match(both.detail, /extrapolating/);
  const verdictNow = now({ in_domain: false, alarms: [alarm({ id: "domain.input", title: "Water beyond" })] });
  assert.equal(verdictNow.detail, "Water beyond.");
});

test("an alarm that went and waits to be seen is not shown as active", () => {
  const gone = alarm({ active: false, acknowledged: false, title: "Bridle 3 is heavily loaded" });
  assert.match(now({ alarms: [gone] }).detail, /^Bridle 3 is heavily loaded, over by now\.$/);
});

test("a lost connection is never well, whatever came last", () => {
  const { kind, detail } = verdict({
    connection: "lost", live: { t: Date.UTC(2026, 0, 2, 3, 4), stale: true, ageS: 1, state: state() },
  });
  assert.equal(kind, "lost");
  assert.equal(detail, "What is shown is of 2026-01-02 03:04 UTC.");
});

test("an input that has grown too old on the page is not well", () => {
  const live = { t: 0, stale: true, ageS: 7200, state: state() };
  assert.equal(verdict({ connection: "live", live }).headline, "Input too old");
});
