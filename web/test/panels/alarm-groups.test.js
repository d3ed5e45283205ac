import assert from "node:assert/strict";
import { test } from "node:test";

import { grouped, titleOf, unseen } from "../../src/panels/alarm-groups.js";
import { verdict } from "../../src/panels/verdict.js";

const minute = (m) => new Date(Date.UTC(2026, 0, 1, 0, m)).toISOString();
const alarm = (id, since, changes = {}) => ({
  id, title: `${id} is up`, severity: 500, active: true, acknowledged: false, shelved: false,
  in_service: true, since: minute(since), ...changes,
});
const ids = (groups) => groups.map((group) => group.map(({ id }) => id));

test("streams that fall silent together are one group, whatever their timeouts", () => {
  const sensors = ["depth-1", "depth-2"].map((one) => alarm(`silent.${one}`, 15, { raise_at: 900 }));
  const buoy = alarm("silent.buoy-1", 180, { raise_at: 10800, severity: 600 });
  const groups = grouped([buoy, ...sensors]);
  assert.deepEqual(ids(groups), [["silent.buoy-1", "silent.depth-1", "silent.depth-2"]]);
  assert.equal(titleOf(groups[0]), "3 streams without readings");
});

test("what happens hours apart, or is of another kind, has another cause", () => {
  const alarms = [alarm("silent.depth-1", 0), alarm("silent.depth-2", 200), alarm("load.bridle-3", 0)];
  assert.equal(grouped(alarms).length, 3);
  assert.equal(titleOf(grouped(alarms)[0]), "silent.depth-1 is up");
});

test("an active alarm is in no group with one that has cleared", () => {
  const gone = alarm("load.bridle-4", 1, { active: false });
  assert.deepEqual(ids(grouped([alarm("load.bridle-3", 0), gone])), [["load.bridle-3"], ["load.bridle-4"]]);
});

test("groups and what is in them keep their order", () => {
  const alarms = [alarm("load.bridle-9", 5), alarm("clock.service", 0), alarm("load.bridle-3", 1)];
  assert.deepEqual(ids(grouped(alarms)), [["load.bridle-9", "load.bridle-3"], ["clock.service"]]);
});

test("those of a group that are acknowledged already are not acknowledged again", () => {
  const group = [alarm("load.bridle-3", 0, { acknowledged: true }), alarm("load.bridle-4", 0)];
  assert.deepEqual(unseen(group).map(({ id }) => id), ["load.bridle-4"]);
});

test("the verdict names the cause once and counts what else there is", () => {
  const alarms = [alarm("load.bridle-3", 0), alarm("load.bridle-4", 1), alarm("clock.service", 2, { severity: 400 })];
  const state = { valid: true, in_domain: true, reason: "", age_s: 1, silent: [], alarms };
  const { headline, detail } = verdict({ connection: "live", live: { t: 0, stale: false, ageS: 1, state } });
  assert.equal(headline, "3 alarms");
  assert.equal(detail, "High load on 2 lines and 1 more.");
});
