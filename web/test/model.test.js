// The model: what is shown is what was asked for, and old is called old.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";

import { topologyOf } from "../dev/cage.js";
import { encodeFrame } from "../dev/encode.js";
import { Model, viewOf } from "../src/model.js";

const topology = { ...topologyOf("calm", 1), topology_id: "one" };
const nodes = topology.rest_position_m.length;
let sockets, calls, answers;

class Socket {
  static CLOSING = 2;

  constructor(url) {
    Object.assign(this, { url: String(url), sent: [], readyState: 1 });
    sockets.push(this);
  }

  send(message) { this.sent.push(message); }

  close(code = 1000) {
    this.readyState = 3;
    this.onclose?.({ code });
  }
}

const frame = (t, flags = 3, state = {}) => encodeFrame({
  t, flags, state: { t: new Date(t).toISOString(), age_s: 60, valid: true, ...state },
  displacement: new Array(3 * nodes).fill(0.1), sigma: new Array(nodes).fill(0.1),
});

/** A browser small enough for the model. */
beforeEach(() => {
  mock.timers.reset();
  mock.timers.enable({ apis: ["setInterval", "setTimeout"] });
  [sockets, calls] = [[], []];
  answers = { cages: { cages: [{ name: "calm" }] } };
  const store = new Map([["seacage-token", "secret"]]);
  Object.assign(globalThis, {
    document: { hidden: false, addEventListener() {}, removeEventListener() {} },
    history: { replaceState() {} },
    location: { hash: "", search: "", pathname: "/", href: "http://cage.test/" },
    sessionStorage: {
      getItem: (key) => store.get(key) ?? null, setItem: (key, value) => store.set(key, value),
      removeItem: (key) => store.delete(key),
    },
    WebSocket: Socket,
    fetch: async (path, { method, headers, body }) => {
      calls.push({ path, method, headers, body });
      const found = answers[Object.keys(answers).find((key) => path.includes(key))];
      const status = found?.status ?? (found ? 200 : 404);
      const bytes = found instanceof ArrayBuffer;
      return {
        ok: status < 400, status, statusText: "No", json: async () => found,
        arrayBuffer: async () => found,
        headers: new Headers({ "Content-Type": bytes ? "application/octet-stream" : "application/json" }),
      };
    },
  });
});

async function opened() {
  const model = new Model();
  await model.open();
  const [socket] = sockets;
  socket.onopen();
  socket.onmessage({ data: JSON.stringify(topology) });
  socket.onmessage({ data: frame(1000) });
  return { model, socket };
}

test("the token goes in the first message and in no address", async () => {
  const { socket } = await opened();
  assert.deepEqual(socket.sent, ['{"token":"secret"}']);
  assert.ok(!socket.url.includes("secret"));
  assert.equal(calls[0].headers.Authorization, "Bearer secret");
});

test("a frame makes the connection live and is shown", async () => {
  const { model } = await opened();
  assert.equal(model.connection, "live");
  assert.equal(model.view.mode, "live");
  assert.equal(model.view.position.length, 3 * nodes);
  assert.equal(model.view.sigma.length, nodes);
});

test("without a token the page asks for one and calls nobody", async () => {
  globalThis.sessionStorage.removeItem("seacage-token");
  const model = new Model();
  await model.open();
  assert.equal(model.connection, "asking");
  assert.equal(calls.length + sockets.length, 0);
});

test("a token that is refused is dropped and asked for again", async () => {
  answers = { cages: { status: 401, detail: "No." } };
  const model = new Model();
  await model.open();
  assert.equal(model.connection, "asking");
  assert.match(model.why, /does not open the service/);
  assert.equal(globalThis.sessionStorage.getItem("seacage-token"), null);
});

test("a token that came too late is not thrown away, but sent again", async () => {
  const { model, socket } = await opened();
  socket.close(4408);
  assert.equal(model.connection, "lost");
  mock.timers.tick(1000);
  assert.equal(sockets.length, 2);
  sockets[1].onopen();
  assert.deepEqual(sockets[1].sent, ['{"token":"secret"}']);
});

test("without a token nothing is asked of the service", async () => {
  const model = new Model();
  globalThis.sessionStorage.removeItem("seacage-token");
  await assert.rejects(model.call("GET", "cages/calm/alarms"), { status: 401 });
  assert.equal(calls.length, 0);
});

test("a token without the scope is told so", async () => {
  const { model, socket } = await opened();
  socket.close(4403);
  assert.equal(model.connection, "refused");
  assert.match(model.why, /may not read/);
});

test("the past stays on the page while live frames come, until the reader goes back", async () => {
  const { model, socket } = await opened();
  answers = { "frame?at=": frame(500, 7) };
  await model.travel(new Date(500));
  socket.onmessage({ data: frame(2000) });
  assert.deepEqual([model.view.mode, model.view.t, model.live.t], ["past", 500, 2000]);
  await model.travel(null);
  assert.deepEqual([model.view.mode, model.view.t], ["live", 2000]);
});

test("a what-if that is answered too late is not shown", async () => {
  const { model } = await opened();
  answers = { whatif: frame(1, 11) };
  const wish = model.whatIf({ current_speed_m_s: 1 });
  await model.whatIf(null);
  await wish;
  assert.equal(model.view.mode, "live");
});

test("a refused call carries the service's own words", async () => {
  const { model } = await opened();
  answers = { whatif: { status: 422, detail: [{ loc: ["body", "hs_m"], msg: "too high" }] } };
  await assert.rejects(model.whatIf({ hs_m: 99 }), /hs_m: too high/);
});

test("a lost connection is tried again, and what is shown is old by then", async () => {
  const { model, socket } = await opened();
  assert.equal(model.view.stale, false);
  socket.close(1006);
  assert.equal(model.connection, "lost");
  assert.equal(model.view.stale, true);
  mock.timers.tick(1000);
  assert.equal(sockets.length, 2);
});

test("a service that falls silent counts as lost", async () => {
  const { model } = await opened();
  mock.timers.tick(15_000);
  assert.equal(model.connection, "lost");
});

test("a service that speaks another version stops the page with the reason", async () => {
  const { model, socket } = await opened();
  const newer = frame(3000);
  new DataView(newer).setUint16(4, 9, true);
  socket.onmessage({ data: newer });
  assert.equal(model.connection, "refused");
  assert.match(model.why, /version 9; this page reads 1/);
  mock.timers.tick(60_000);
  assert.equal(sockets.length, 1);
});

test("a topology that is already known is not built again", async () => {
  const { model, socket } = await opened();
  const built = [];
  model.on("topology", (one) => built.push(one));
  socket.onmessage({ data: JSON.stringify(topology) });
  socket.onmessage({ data: JSON.stringify({ ...topology, topology_id: "two" }) });
  assert.equal(built.length, 1);
});

test("a selection is told once", () => {
  const model = new Model();
  const told = [];
  model.on("selection", (one) => told.push(one));
  model.select({ bridle: "bridle-1" });
  model.select({ bridle: "bridle-1" });
  model.select(null);
  assert.deepEqual(told, [{ bridle: "bridle-1" }, null]);
});

test("input older than the limit is stale, and the past never is", () => {
  const how = { staleAfterS: 100, speed: 1, isLost: () => false };
  const old = { state: { age_s: 101 } };
  assert.equal(viewOf(old, "live", how).stale, true);
  assert.equal(viewOf(old, "past", how).stale, false);
  assert.equal(viewOf({ state: { age_s: null } }, "live", how).ageS, null);
});

test("a line that falls silent is lost at once, even where it takes its time to close", async () => {
  const { model, socket } = await opened();
  socket.close = () => {};
  mock.timers.tick(15_000);
  assert.equal(model.connection, "lost");
  mock.timers.tick(1000);
  assert.equal(sockets.length, 2);
});
