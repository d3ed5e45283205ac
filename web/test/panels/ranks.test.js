import assert from "node:assert/strict";
import { test } from "node:test";

import { actionsFor, shelvesFor } from "../../src/panels/alarm-actions.js";
import { fresh } from "../../src/panels/fresh.js";
import { alarmed, sourceOf } from "../../src/panels/load-rows.js";
import { ordered, rank, standing, worst } from "../../src/panels/ranks.js";
import { worth } from "../../src/panels/worth.js";

const alarm = (id, changes = {}) => ({
  id, severity: 600, active: true, acknowledged: false, shelved: false, in_service: true,
  since: "2026-01-01T00:00:00Z", ...changes,
});

test("a severity has one of three ranks", () => {
  assert.deepEqual([1000, 800, 799, 500, 499, 1].map(rank),
    ["critical", "critical", "warning", "warning", "note", "note"]);
});

test("what nobody has seen comes first, then the worst, then the newest", () => {
  const alarms = [
    alarm("shelved", { shelved: true, severity: 1000 }),
    alarm("seen", { acknowledged: true, severity: 900 }),
    alarm("old"), alarm("new", { since: "2026-01-02T00:00:00Z" }), alarm("worst", { severity: 850 }),
  ];
  assert.deepEqual(ordered(alarms).map(({ id }) => id), ["worst", "new", "old", "seen", "shelved"]);
});

test("what is active stands above what has cleared, however bad that was", () => {
  const alarms = [
    alarm("gone", { active: false, severity: 900 }), alarm("seen", { acknowledged: true, severity: 300 }),
    alarm("here", { severity: 400 }),
  ];
  assert.deepEqual(ordered(alarms).map(({ id }) => id), ["here", "seen", "gone"]);
});

test("the worst is of those that wait", () => {
  assert.equal(worst([alarm("a", { shelved: true }), alarm("b", { in_service: false })]), null);
  assert.equal(worst([alarm("a"), alarm("b", { severity: 900 })]).id, "b");
});

test("the state of an alarm is written in words", () => {
  assert.equal(standing(alarm("a")), "active, not acknowledged");
  assert.equal(standing(alarm("a", { active: false })), "cleared, not acknowledged");
  assert.equal(standing(alarm("a", { shelved: true })), "shelved");
  assert.equal(standing(alarm("a", { in_service: false })), "out of service");
});

test("only what makes sense can be done", () => {
  assert.deepEqual(actionsFor(alarm("a")), ["acknowledge", "shelve", "comment", "out-of-service"]);
  assert.deepEqual(actionsFor(alarm("a", { acknowledged: true, shelved: true })),
    ["unshelve", "comment", "out-of-service"]);
  assert.deepEqual(actionsFor(alarm("a", { in_service: false, acknowledged: true })),
    ["in-service", "comment"]);
});

test("only an active alarm is shelved until it clears", () => {
  const forever = (one) => shelvesFor(one).some(([, seconds]) => seconds === null);
  assert.ok(forever(alarm("a")));
  assert.ok(!forever(alarm("a", { active: false })));
});

test("an alarm is news once", () => {
  assert.deepEqual(fresh([], [alarm("a")]).map(({ id }) => id), ["a"]);
  assert.deepEqual(fresh([alarm("a")], [alarm("a")]), []);
});

test("an alarm is news again when it comes back after it was seen", () => {
  assert.equal(fresh([alarm("a", { acknowledged: true })], [alarm("a")]).length, 1);
});

test("a shelved or cleared alarm is no news", () => {
  assert.deepEqual(fresh([], [alarm("a", { shelved: true }), alarm("b", { active: false })]), []);
});

test("what an alarm is about has the worst rank of its alarms", () => {
  const ranks = alarmed([alarm("load.bridle-3", { severity: 900 }), alarm("bridle.bridle-3")]);
  assert.equal(ranks.get("bridle-3"), "critical");
  assert.equal(sourceOf("irregular.depth-2"), "depth-2");
});

test("an alarm's number is shown only where it means something", () => {
  assert.equal(worth("load.bridle-3", 0.96), "96 %");
  assert.equal(worth("silent.buoy-1", 7200), "2 h");
  assert.equal(worth("irregular.depth-2", 9.1), "");
  assert.equal(worth("load.bridle-3", null), "");
});
