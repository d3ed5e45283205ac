// When the alarms are asked for.

import assert from "node:assert/strict";
import { mock, test } from "node:test";

globalThis.document = { hidden: false };
mock.timers.enable({ apis: ["setInterval"] });
const { AlarmDesk } = await import("../../src/panels/alarm-desk.js");

function modelOf(call) {
  const heard = {};
  return {
    heard, call, cageName: "ace", connection: "live",
    on: (name, fn) => { heard[name] = fn; },
  };
}
const load = { id: "load.bridle-3", active: true, acknowledged: false, shelved: false, severity: 700 };

test("a slow answer is waited for, however many updates come meanwhile", async () => {
  const asked = [];
  const model = modelOf(() => new Promise((come) => asked.push(come)));
  const desk = new AlarmDesk(model);
  for (let k = 0; k < 5; k += 1) model.heard.live({ state: { alarms: [] } });
  assert.equal(asked.length, 1);
  asked[0]({ alarms: [load] });
  await Promise.resolve();
  await Promise.resolve();
  assert.deepEqual(desk.alarms, [load]);
});

test("alarms of one cause are acknowledged together, with one reason", async () => {
  const asked = [];
  const model = modelOf(async (method, path, body) => {
    asked.push([method, path, body?.why]);
    return { alarms: [] };
  });
  const desk = new AlarmDesk(model);
  await desk.acknowledge(["load.bridle-3", "load.bridle-4"], { why: "Spring tide" });
  assert.deepEqual(asked, [
    ["POST", "cages/ace/alarms/load.bridle-3/acknowledge", "Spring tide"],
    ["POST", "cages/ace/alarms/load.bridle-4/acknowledge", "Spring tide"],
    ["GET", "cages/ace/alarms", undefined],
  ]);
});

test("they are asked for again once one has changed, and not for another cage's", async () => {
  const asked = [];
  const model = modelOf(() => new Promise((come) => asked.push(come)));
  const desk = new AlarmDesk(model);
  model.heard.live({ state: { alarms: [] } });
  model.heard.live({ state: { alarms: [load] } });
  model.heard.live({ state: { alarms: [{ ...load, value: 0.9 }] } });
  assert.equal(asked.length, 2);
  model.heard.topology();
  asked[1]({ alarms: [load] });
  await Promise.resolve();
  await Promise.resolve();
  assert.equal(desk.alarms, null);
});
