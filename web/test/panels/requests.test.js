import assert from "node:assert/strict";
import { mock, test } from "node:test";

import { AlarmDesk } from "../../src/panels/alarm-desk.js";
import { Past } from "../../src/panels/past.js";
import { Playback } from "../../src/panels/playback.js";

globalThis.document ??= { hidden: false };

/** A model that gives a set answer and records the requests. */
function modelOf(answers) {
  const listeners = {};
  return {
    connection: "live", cageName: "a cage", requests: [],
    on(name, fn) { (listeners[name] ??= []).push(fn); },
    notify(name, value) { for (const fn of listeners[name] ?? []) fn(value); },
    async call(method, path, body) {
      this.requests.push([method, path, body]);
      const answer = answers.shift();
      if (answer instanceof Error) throw answer;
      return answer;
    },
  };
}

const settled = () => new Promise((resolve) => { setImmediate(resolve); });
const at = (s) => new Date(1000 * s).toISOString();
const history = (times) => ({
  t: times.map(at), current_speed_m_s: times.map(() => 0.1), current_to_deg: times.map(() => 90),
  volume_fraction: times.map(() => 1), bridles: {}, sensors: {}, measured: {},
});
const live = (s) => ({ t: 1000 * s, state: {
  t: at(s), valid: true, water: null, volume_fraction: 1, bridles: [], sensors: [], amended: [],
} });

test("the past is requested once, over the span, and goes on with what comes", async () => {
  const model = modelOf([history([90_000, 99_000])]);
  const past = new Past(model);
  model.notify("live", live(100_000));
  await settled();
  model.notify("live", live(100_060));
  assert.equal(model.requests.length, 1);
  assert.equal(model.requests[0][1],
    `cages/a%20cage/history?from=${encodeURIComponent(at(100_000 - 86_400))}&limit=2000`);
  assert.deepEqual(past.columns.t, [90_000, 99_000, 100_060]);
});

test("a clock that goes back has the past requested anew", async (context) => {
  const clock = context.mock.method(performance, "now", () => 0);
  const model = modelOf([history([99_000]), history([10])]);
  const past = new Past(model);
  model.notify("live", live(100_000));
  await settled();
  clock.mock.mockImplementation(() => 60_000);
  model.notify("live", live(20));
  await settled();
  assert.deepEqual(past.columns.t, [10]);
});

test("a past that does not come says why", async () => {
  const model = modelOf([new Error("The store cannot be read.")]);
  const past = new Past(model);
  model.notify("live", live(100_000));
  await settled();
  assert.equal(past.fault, "The store cannot be read.");
  assert.equal(past.columns, null);
});

test("an answer for another cage is thrown away", async () => {
  const model = modelOf([history([99_000])]);
  const past = new Past(model);
  model.notify("live", live(100_000));
  model.notify("topology");
  await settled();
  assert.equal(past.columns, null);
});

test("the past is played so fast as was chosen, and ends in the present", (context) => {
  context.mock.timers.enable({ apis: ["setInterval"] });
  const seen = [];
  let ended = 0;
  const playback = new Playback({ go: (t) => seen.push(t), ended: () => { ended += 1; } });
  playback.speed = 10;
  playback.start(0, () => 5000);
  context.mock.timers.tick(400);
  assert.deepEqual(seen, [2000, 4000]);
  assert.ok(playback.playing);
  context.mock.timers.tick(200);
  assert.deepEqual([seen.length, ended, playback.playing], [2, 1, false]);
});

const alarm = { id: "load.bridle-1", severity: 900, active: true, acknowledged: false, shelved: false };

test("alarms are requested where the live state shows a change", async () => {
  mock.timers.enable({ apis: ["setInterval"] });
  const model = modelOf([{ alarms: [alarm] }, { alarms: [] }]);
  const desk = new AlarmDesk(model);
  for (const alarms of [[alarm], [alarm], []]) {
    model.notify("live", { state: { alarms } });
    await settled();
  }
  mock.timers.reset();
  assert.equal(model.requests.length, 2);
  assert.deepEqual(desk.waiting, []);
});

test("what is done with an alarm is sent with its reason, and a token that may not is remembered", async () => {
  mock.timers.enable({ apis: ["setInterval"] });
  const model = modelOf([{}, { alarms: [alarm] }, Object.assign(new Error("No."), { status: 403 })]);
  const desk = new AlarmDesk(model);
  await desk.act(alarm.id, "shelve", { why: "divers", seconds: 60 });
  assert.deepEqual(model.requests[0],
    ["POST", "cages/a%20cage/alarms/load.bridle-1/shelve", { why: "divers", seconds: 60 }]);
  assert.equal(desk.denied, false);
  await assert.rejects(desk.act(alarm.id, "acknowledge", { why: "" }), /No\./);
  mock.timers.reset();
  assert.equal(desk.denied, true);
});
