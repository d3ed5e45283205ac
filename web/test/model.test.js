// The model: what is shown is what was requested, and old is called old.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";

import { topologyOf } from "../dev/cage.js";
import { encodeFrame } from "../dev/encode.js";
import { Model, viewOf } from "../src/model.js";
import { forget } from "../src/session.js";

const topology = { ...topologyOf("calm", 1), topology_id: "one" };
const nodes = topology.rest_position_m.length;
const session = { who: "ada", scopes: ["read"], csrf: "sent once", expires: "2100-01-01T00:00:00Z" };
let sockets, calls, answers, reloaded;

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
  [sockets, calls, reloaded] = [[], [], 0];
  answers = { session, cages: { cages: [{ name: "calm" }] } };
  const store = new Map();
  Object.assign(globalThis, {
    document: { hidden: false, addEventListener() {}, removeEventListener() {} },
    history: { replaceState() { location.hash = ""; } },
    location: { hash: "#token=secret", search: "", pathname: "/", href: "http://cage.test/", reload() { reloaded += 1; } },
    localStorage: {
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
  forget();
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

test("the token goes to the service once, and in no address", async () => {
  const { socket } = await opened();
  const [request, ...later] = calls;
  assert.deepEqual([request.method, request.path, request.body], ["POST", "session", '{"token":"secret"}']);
  assert.equal(location.hash, "");
  assert.deepEqual(socket.sent, ['{"token":null}']);
  assert.ok(!JSON.stringify([later, socket]).includes("secret"));
});

test("a page that is loaded again goes on with its cookie", async () => {
  localStorage.setItem("seacage-signed-in", "yes");
  location.hash = "";
  const { model } = await opened();
  assert.deepEqual([calls[0].method, calls[0].path], ["GET", "session"]);
  assert.equal(model.session.who, "ada");
});

test("a write repeats the secret of the session, a read does not", async () => {
  const { model } = await opened();
  answers = { alarms: {} };
  await model.call("POST", "cages/calm/alarms/a/acknowledge", {});
  await model.call("GET", "cages/calm/alarms");
  assert.deepEqual(calls.slice(-2).map(({ headers }) => headers["X-CSRF-Token"]), ["sent once", undefined]);
});

test("where another tab has signed in anew, a write is repeated with its secret", async () => {
  const { model } = await opened();
  answers = { session: { ...session, csrf: "another" }, alarms: { status: 403, detail: "No." } };
  await assert.rejects(model.call("POST", "cages/calm/alarms/a/acknowledge", {}), { status: 403 });
  assert.deepEqual(calls.slice(-3).map(({ path, headers }) => [path.split("/").at(-1), headers["X-CSRF-Token"]]),
    [["acknowledge", "sent once"], ["session", undefined], ["acknowledge", "another"]]);
});

test("signing out ends the session and leaves nothing", async () => {
  const { model } = await opened();
  await model.leave();
  const { method, path, headers } = calls.at(-1);
  assert.deepEqual([method, path, headers["X-CSRF-Token"]], ["DELETE", "session", "sent once"]);
  assert.equal(reloaded, 1);
  await assert.rejects(model.call("GET", "cages/calm/alarms"), { status: 401 });
});

test("a page that is open stays signed in", async () => {
  await opened();
  const before = calls.length;
  mock.timers.tick(3600e3);
  assert.ok(calls.slice(before).some(({ method, path }) => method === "GET" && path === "session"));
});

test("a frame makes the connection live and is shown", async () => {
  const { model } = await opened();
  assert.equal(model.connection, "live");
  assert.equal(model.view.mode, "live");
  assert.equal(model.view.position.length, 3 * nodes);
  assert.equal(model.view.sigma.length, nodes);
});

test("without a token the page asks for one and calls nobody", async () => {
  location.hash = "";
  const model = new Model();
  await model.open();
  assert.deepEqual([model.connection, model.why], ["asking", ""]);
  assert.equal(calls.length + sockets.length, 0);
});

test("a token that is refused is dropped and requested again", async () => {
  answers = { session: { status: 401, detail: "No." } };
  const model = new Model();
  await model.open();
  assert.equal(model.connection, "asking");
  assert.match(model.why, /does not open the service/);
  await model.open();
  assert.equal(calls.length, 1);
});

test("a session that ended while the page was closed is reported as such", async () => {
  localStorage.setItem("seacage-signed-in", "yes");
  location.hash = "";
  answers = { session: { status: 401, detail: "No." } };
  const model = new Model();
  await model.open();
  assert.equal(model.connection, "asking");
  assert.match(model.why, /no longer signed in/);
});

test("whoever tries too often reads the service's words to wait", async () => {
  answers = { session: { status: 429, detail: "Ask again in 3 s." } };
  const model = new Model();
  await model.open();
  assert.deepEqual([model.connection, model.why], ["asking", "Ask again in 3 s."]);
});

test("a browser that keeps no cookie is reported", async () => {
  answers = { session, cages: { status: 401, detail: "No." } };
  const model = new Model();
  await model.open();
  assert.equal(model.connection, "asking");
  assert.match(model.why, /keeps no cookie/);
});

test("a service that does not answer yet gets the token again", async () => {
  globalThis.fetch = async () => { throw new Error("nobody there"); };
  const model = new Model();
  await model.open();
  assert.equal(model.connection, "lost");
  let given;
  globalThis.fetch = async (path, { body }) => { given = [path, body]; throw new Error("still"); };
  mock.timers.tick(3000);
  assert.deepEqual(given, ["session", '{"token":"secret"}']);
});

test("a session that has ended is reported, and a token requested", async () => {
  const { model, socket } = await opened();
  socket.close(4401);
  assert.equal(model.connection, "asking");
  assert.match(model.why, /no longer signed in/);
});

test("a first message that came too late is sent again", async () => {
  const { model, socket } = await opened();
  socket.close(4408);
  assert.equal(model.connection, "lost");
  mock.timers.tick(1000);
  assert.equal(sockets.length, 2);
  sockets[1].onopen();
  assert.deepEqual(sockets[1].sent, ['{"token":null}']);
});

test("without a token nothing is requested of the service", async () => {
  const model = new Model();
  await assert.rejects(model.call("GET", "cages/calm/alarms"), { status: 401 });
  assert.equal(calls.length, 0);
});

test("a token without the scope is reported", async () => {
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
  assert.match(model.why, /version 9; this page reads 2/);
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

test("a selection is announced once", () => {
  const model = new Model();
  const selections = [];
  model.on("selection", (one) => selections.push(one));
  model.select({ bridle: "bridle-1" });
  model.select({ bridle: "bridle-1" });
  model.select(null);
  assert.deepEqual(selections, [{ bridle: "bridle-1" }, null]);
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
