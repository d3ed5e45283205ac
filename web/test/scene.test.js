// The arithmetic behind the drawings.

import assert from "node:assert/strict";
import { test } from "node:test";

import { topologyOf } from "../dev/cage.js";
import { rank } from "../src/panels/ranks.js";
import { alarmed, cssColour } from "../src/scene/colours.js";
import { roundLength } from "../src/scene/furniture.js";
import {
  bearingOf, extent, movedBy, nodeNormals, smoothLoop, towards, triangles, tubeRing,
} from "../src/scene/geometry.js";
import { Glide } from "../src/scene/glide.js";
import { noticeFor } from "../src/scene/notice.js";
import { pick, toSegment } from "../src/scene/pick.js";
import { band, outline } from "../src/scene/silhouette.js";
import { wordsFor } from "../src/scene/words.js";

globalThis.matchMedia = () => ({ matches: false, addEventListener() {} });
globalThis.localStorage = { getItem: () => null };
globalThis.document = { documentElement: { dataset: {} } };
const { tintOf } = await import("../src/scene/paint.js");
const made = topologyOf("calm", 1);
const topology = { ...made, rest: Float32Array.from(made.rest_position_m.flat()) };

test("the triangles close the net below and leave it open above", () => {
  const seen = new Map();
  const index = triangles(topology);
  for (let k = 0; k < index.length; k += 3) {
    for (const [a, b] of [[0, 1], [1, 2], [2, 0]]) {
      const edge = [index[k + a], index[k + b]].sort((p, q) => p - q).join();
      seen.set(edge, (seen.get(edge) ?? 0) + 1);
    }
  }
  const open = [...seen].filter(([, count]) => count === 1).map(([edge]) => edge.split(",").map(Number));
  assert.equal(open.length, topology.spokes);
  assert.ok(open.flat().every((node) => node < topology.spokes));
});

test("the normals of the net at rest point outwards", () => {
  const { rest } = topology;
  const normal = nodeNormals(rest, triangles(topology), new Float32Array(rest.length));
  for (let k = 0; k < topology.spokes * topology.rings; k += 1) {
    assert.ok(normal[3 * k] * rest[3 * k] + normal[3 * k + 1] * rest[3 * k + 1] > 0, `node ${k}`);
  }
  assert.ok(normal.at(-1) < -0.9);
});

test("the sinker tube hangs where the cylinder ends", () => {
  assert.equal(tubeRing(topology), 5);
});

test("the extent is that of the net and its frame", () => {
  const { reach, depth, frame } = extent(topology);
  assert.deepEqual([reach, depth].map(Math.round), [25, 31]);
  assert.ok(Math.abs(frame - Math.hypot(42.5, 42.5)) < 1e-9);
});

test("bearings count clockwise from north", () => {
  assert.deepEqual([[0, 1], [1, 0], [0, -1], [-1, 0]].map(([x, y]) => bearingOf(x, y)),
    [0, 90, 180, 270]);
  const [east, north] = towards(90);
  assert.ok(Math.abs(east - 1) + Math.abs(north) < 1e-12);
});

test("a smooth loop goes through its points", () => {
  const points = [[0, 0, 0], [2, 0, 1], [2, 2, 0], [0, 2, -1]];
  const curve = smoothLoop(points, 4);
  assert.equal(curve.length, 16);
  points.forEach((point, k) => assert.deepEqual(curve[4 * k], point));
});

test("what has moved is measured from still water", () => {
  const moved = topology.rest.map((metres, k) => metres + (k % 3 === 0 ? 3 : k % 3 === 1 ? 4 : 0));
  assert.ok(movedBy(moved, topology.rest).every((metres) => Math.abs(metres - 5) < 1e-5));
});

test("the net glides to where it is, and stands there", () => {
  const glide = new Glide(Float32Array.from([0, 0, 0]));
  glide.aim(Float32Array.from([0, 0, 0]), null, 1000);
  glide.step(1000);
  glide.aim(Float32Array.from([2, 0, 0]), null, 2000);
  assert.equal(glide.step(2500), true);
  assert.equal(glide.position[0], 1);
  assert.equal(glide.step(3000), false);
  assert.equal(glide.position[0], 2);
});

test("a sensor under the pointer goes before the bridle behind it", () => {
  const lines = [{ selection: { bridle: "b" }, from: [0, 0, 0], to: [100, 0, 0] }];
  const sensors = [{ name: "s", at: [50, 4, 0] }];
  assert.deepEqual(pick([50, 0], { sensors, lines, nodes: [] }, false), { sensor: "s" });
  assert.deepEqual(pick([20, 2], { sensors, lines, nodes: [] }, false), { bridle: "b" });
  assert.equal(pick([20, 60], { sensors, lines, nodes: [] }, false), null);
});

test("of two nodes under the pointer the nearer one is meant", () => {
  const nodes = [[10, 10, 0.9], [12, 10, 0.2], null];
  assert.deepEqual(pick([10, 10], { sensors: [], lines: [], nodes }, false), { node: 1 });
});

test("the distance to a segment ends with the segment", () => {
  assert.equal(toSegment([5, 3], [0, 0], [10, 0]), 3);
  assert.equal(toSegment([-3, 4], [0, 0], [10, 0]), 5);
  assert.equal(toSegment([0, 0], null, [10, 0]), Infinity);
});

test("the scale bar has a round length that fits", () => {
  assert.deepEqual([roundLength(1), roundLength(7), roundLength(30)], [100, 20, 5]);
});

test("colours outside the scale stay at its ends", () => {
  assert.equal(cssColour(-1), cssColour(0));
  assert.equal(cssColour(7), cssColour(1));
  assert.notEqual(cssColour(0.2), cssColour(0.8));
});

test("the worst active alarm of a source gives its rank, and a shelved one none", () => {
  const alarm = (id, severity, rest = {}) => ({ id, severity, active: true, shelved: false, ...rest });
  const found = alarmed({ alarms: [
    alarm("load.bridle-3", 600), alarm("bridle.bridle-3", 900), alarm("silent.depth-1", 500, { shelved: true }),
  ] });
  assert.deepEqual([...found], [["bridle-3", "critical"]]);
  assert.deepEqual([800, 799, 499].map(rank), ["critical", "warning", "note"]);
});

test("without valid input a bridle shows dashes and the reason", () => {
  const nothing = { mean: null, lower: null, upper: null };
  const state = {
    valid: false, in_domain: false, reason: "buoy-1 is silent.", sensors: [],
    bridles: [{ name: "bridle-1", level: 1, tension_kn: nothing, utilisation: null }],
  };
  const words = wordsFor({ bridle: "bridle-1" }, topology, { state });
  assert.deepEqual(words.rows.map(([, value]) => value), ["–", "–", "–"]);
  assert.equal(words.note, "buoy-1 is silent.");
});

test("a line outside the training domain of its own level is labelled, and one without an interval says why", () => {
  const bridle = { name: "bridle-1", level: 2, in_domain: false, interval_reason: "", utilisation: 0.2,
    tension_kn: { mean: 32, lower: 30, upper: 34 } };
  const state = { valid: true, in_domain: true, reason: "", sensors: [], bridles: [bridle] };
  assert.match(wordsFor({ bridle: "bridle-1" }, topology, { state }).note, /Outside the training domain/);
  const none = { mean: 32, lower: null, upper: null };
  state.bridles = [{ ...bridle, level: 1, in_domain: true, interval_reason: "No sensor.", tension_kn: none }];
  const words = wordsFor({ bridle: "bridle-1" }, topology, { state });
  assert.equal(words.rows[1][1], "not known");
  assert.equal(words.note, "From simulations alone. No sensor.");
});

test("a node without a spread says that it is not known, and why", () => {
  const state = { valid: true, shape: { interval_reason: "No sensor has trained the shape." } };
  const words = wordsFor({ node: 3 }, topology, { state, position: topology.rest, sigma: null });
  assert.deepEqual(words.rows.at(-1), ["Uncertainty, σ", "not known"]);
  assert.equal(words.note, "No sensor has trained the shape.");
  assert.equal(tintOf(topology, { position: topology.rest, sigma: null }, { tint: "sigma" }), null);
});

test("the outline of the net goes from the collar to the tip and back, and the band is on both sides", () => {
  const side = ([x, , z]) => [x, -z];
  const line = outline(topology, topology.rest, side);
  assert.equal(line.length, 2 * topology.rings + 1);
  assert.deepEqual(line[topology.rings].map(Math.round), [0, 31]);
  assert.deepEqual([line[0], line.at(-1)].map(([x]) => Math.round(x)), [-25, 25]);
  const sigma = new Float32Array(topology.rest.length / 3).fill(1);
  const [outer, inner] = band(topology, topology.rest, sigma, (net) => outline(topology, net, side));
  assert.ok(outer[0][0] < line[0][0] - 1.5 && inner[0][0] > line[0][0] + 1.5);
  assert.ok(outer[topology.rings][1] > 32.5);
});

test("every state of the page has its notice, and a live one none", () => {
  const valid = { stale: false, state: { valid: true, age_s: 1 } };
  const kind = (model) => noticeFor({ why: "", view: null, ...model })?.kind;
  assert.equal(kind({ connection: "connecting" }), "connecting");
  assert.equal(kind({ connection: "lost" }), "lost");
  assert.equal(kind({ connection: "refused" }), "refused");
  assert.equal(kind({ connection: "live", view: { state: { valid: false, age_s: null } } }), "empty");
  assert.equal(kind({ connection: "live", view: { state: { valid: false, age_s: 9e3 } } }), "invalid");
  assert.equal(kind({ connection: "live", view: { ...valid, stale: true } }), "stale");
  assert.equal(kind({ connection: "live", view: valid }), undefined);
});
