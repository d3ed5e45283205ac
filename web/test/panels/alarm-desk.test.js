// When the alarms are requested.

import assert from "node:assert/strict";
import { mock, test } from "node:test";

globalThis.document = { hidden: false };
mock.timers.enable({ apis: ["setInterval"] });
const { AlarmDesk } = await import("../../src/panels/alarm-desk.js");

function modelOf(call) {
  const listeners = {};
  return {
    listeners, call, cageName: "ace", connection: "live",
    on: (name, fn) => { listeners[name] = fn; },
  };
}
const load = { id: "load.bridle-3", active: true, acknowledged: false, shelved: false, severity: 700 };

test("a slow answer is waited for, however many updates come meanwhile", async () => {
  const requests = [];
  const model = modelOf(() => new Promise((come) => requests.push(come)));
  const desk = new AlarmDesk(model);
  for (let k = 0; k < 5; k += 1) model.listeners.live({ state: { alarms: [] } });
  assert.equal(requests.length, 1);
  requests[0]({ alarms: [load] });
  await Promise.resolve();
  await Promise.resolve();
  assert.deepEqual(desk.alarms, [load]);
});

test("alarms of one cause are acknowledged together, with one reason", async () => {
  const requests = [];
  const model = modelOf(async (method, path, body) => {
    requests.push([method, path, body?.why]);
    return { alarms: [] };
  });
  const desk = new AlarmDesk(model);
  await desk.acknowledge(["load.bridle-3", "load.bridle-4"], { why: "Spring tide" });
  assert.deepEqual(requests, [
    ["POST", "cages/ace/alarms/load.bridle-3/acknowledge", "Spring tide"],
    ["POST", "cages/ace/alarms/load.bridle-4/acknowledge", "Spring tide"],
    ["GET", "cages/ace/alarms", undefined],
  ]);
});

test("they are requested again once one has changed, and not for another cage's", async () => {
  const requests = [];
  const model = modelOf(() => new Promise((come) => requests.push(come)));
  const desk = new AlarmDesk(model);
  model.listeners.live({ state: { alarms: [] } });
  model.listeners.live({ state: { alarms: [load] } });
  model.listeners.live({ state: { alarms: [{ ...load, value: 0.9 }] } });
  assert.equal(requests.length, 2);
  model.listeners.topology();
  requests[1]({ alarms: [load] });
  await Promise.resolve();
  await Promise.resolve();
  assert.equal(desk.alarms, null);
});
