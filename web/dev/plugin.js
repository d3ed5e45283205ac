// A stand-in for the service, beside Vite: `npm run dev` shows the page without Python.
// Any token opens it but "wrong". Cages: calm is well, storm has alarms, silent has no
// buoy, thin too little volume, dumb no sensor, taut a load at its limit.

import { WebSocketServer } from "ws";

import { alarmsFor, kpi } from "./alarms.js";
import { largestKnown } from "../src/known-load.js";
import { learned, seaAt, topologyOf } from "./cage.js";
import { CONCERNS, frameOf, historyOf, partedOf, stateOf } from "./state.js";

const SPEED = 60;
const EVERY_MS = 1000;
const began = Date.now();
const now = () => began + SPEED * (Date.now() - began);
const cages = new Map([
  { name: "calm", strength: 0.8, spread: true }, { name: "storm", strength: 1.15, trouble: "load" },
  { name: "silent", strength: 0.8, trouble: "silent" },
  { name: "thin", strength: 1, concerns: [CONCERNS.volume] },
  { name: "dumb", strength: 0.8, concerns: [CONCERNS.measured] },
  { name: "taut", strength: 1.1, concerns: [CONCERNS.load, CONCERNS.volume] },
].map((one) => [one.name, { ...one, book: alarmsFor(one.trouble, began) }]));

const session = { who: "Night shift", scopes: ["read", "ack"], csrf: "made up", expires: "2100-01-01T00:00:00Z" };
let signedIn = false;

const live = (one) => frameOf(one, now(), seaAt(now(), one.strength), one.book.brief());

function summaries() {
  return [...cages.values()].map((one) => {
    const state = stateOf(one, now(), seaAt(now(), one.strength), []);
    const waiting = one.book.alarms.filter(({ acknowledged }) => !acknowledged);
    return {
      name: one.name, origin: state.origin, valid: state.valid, in_domain: state.in_domain,
      t: state.t, age_s: state.age_s, reason: state.reason,
      max_utilisation: largestKnown(state)?.share ?? null, concerns: state.concerns,
      volume_fraction: state.volume_fraction,
      current_speed_m_s: state.water?.current_speed_m_s ?? null,
      current_to_deg: state.water?.current_to_deg ?? null, waiting: waiting.length,
      worst_severity: waiting[0]?.severity ?? null, worst_title: waiting[0]?.title ?? null,
    };
  });
}

const GET = {
  topology: (one) => topologyOf(one.name, SPEED),
  state: (one) => stateOf(one, now(), seaAt(now(), one.strength), one.book.brief()),
  frame: (one, { at }) => frameOf(one, at, seaAt(at, one.strength), [], 4),
  history: (one, { from, to, limit }) => historyOf(one, from, to, limit),
  alarms: (one) => ({ alarms: one.book.alarms }),
  journal: (one) => ({ lines: one.book.lines }),
  kpi: () => kpi,
  whatif: () => learned,
  "what-if-parted": (one, { at }) => partedOf(one, at, seaAt(at, one.strength)),
};

function answer(method, path, query, body) {
  if (path === "cages") return { cages: summaries() };
  const [, name, what, id, action] = path.split("/").map(decodeURIComponent);
  const one = cages.get(name);
  if (!one) return null;
  if (method === "POST" && what === "whatif") return frameOf(one, now(), body, [], 8);
  if (method === "POST" && what === "lines") return {};
  if (method === "POST" && what === "alarms") return one.book.act(id, action, body, now());
  const span = {
    from: Date.parse(query.get("from") ?? "") || now() - 864e5,
    to: Date.parse(query.get("to") ?? "") || now(),
    at: Date.parse(query.get("at") ?? "") || now(), limit: Number(query.get("limit") ?? 1000),
  };
  return method === "GET" ? GET[what]?.(one, span) : null;
}

async function bodyOf(request) {
  const chunks = [];
  for await (const chunk of request) chunks.push(chunk);
  return chunks.length ? JSON.parse(Buffer.concat(chunks)) : {};
}

async function signing(request, response) {
  if (request.method === "POST") signedIn = (await bodyOf(request)).token !== "wrong";
  const known = signedIn;
  if (request.method === "DELETE") signedIn = false;
  response.statusCode = known ? 200 : 401;
  response.setHeader("Content-Type", "application/json");
  response.end(JSON.stringify(known ? session : { detail: "Unknown." }));
}

async function serve(request, response, next) {
  const url = new URL(request.url, "http://fake");
  if (url.pathname === "/session") return signing(request, response);
  if (!url.pathname.startsWith("/api/v1/")) return next();
  const send = (status, content) => {
    response.statusCode = status;
    response.setHeader("Content-Type", content instanceof ArrayBuffer
      ? "application/vnd.seacage.frame" : "application/json");
    response.end(content instanceof ArrayBuffer ? Buffer.from(content) : JSON.stringify(content));
  };
  if (!signedIn) return send(401, { detail: "Unknown." });
  const body = await bodyOf(request);
  const found = answer(request.method, url.pathname.slice(8), url.searchParams, body);
  return found ? send(200, found) : send(404, { detail: "There is nothing here." });
}

function listen(server) {
  const sockets = new WebSocketServer({ noServer: true });
  server.httpServer?.on("upgrade", (request, socket, head) => {
    const found = /^\/api\/v1\/cages\/([^/]+)\/live/.exec(request.url);
    if (!found) return;
    sockets.handleUpgrade(request, socket, head, (client) => {
      const one = cages.get(decodeURIComponent(found[1]));
      client.once("message", (first) => {
        if (!signedIn) return client.close(4401);
        if (!one) return client.close(4404);
        client.send(JSON.stringify(topologyOf(one.name, SPEED)));
        client.send(live(one));
        const beat = setInterval(() => client.send(live(one)), EVERY_MS);
        return client.on("close", () => clearInterval(beat));
      });
    });
  });
}

/** The plugin. */
export function fakeService() {
  const configure = (server) => {
    server.middlewares.use((request, response, next) =>
      serve(request, response, next).catch(next));
    listen(server);
  };
  return { name: "fake-service", apply: "serve", configureServer: configure };
}
