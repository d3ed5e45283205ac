// The page reads what the service writes.

import assert from "node:assert/strict";
import { test } from "node:test";

import { encodeFrame } from "../dev/encode.js";
import { IN_DOMAIN, NO_SPREAD, PAST, readFrame, VALID } from "../src/wire.js";

const rest = Float32Array.from([0, 0, 0, 10, 0, -5, 0, 10, -31]);
const displacement = [0.5, -0.25, 0, 40, 0, 3.2767, -12.5, 1e-3, 9];
const sigma = [0.02, 0.4, 1.3];
const frame = (rest_) => encodeFrame({
  t: 1.5e12, flags: VALID | IN_DOMAIN, state: { valid: true, reason: "naïve" }, displacement,
  sigma, ...rest_,
});

test("positions come back to within half a unit of the largest displacement", () => {
  const { position } = readFrame(frame(), rest);
  const half = 40 / 32767 / 2;
  position.forEach((metres, k) =>
    assert.ok(Math.abs(metres - rest[k] - displacement[k]) <= half + 1e-5, `number ${k}`));
});

test("sigma comes back to within half a unit of the largest", () => {
  const read = readFrame(frame(), rest);
  read.sigma.forEach((metres, k) => assert.ok(Math.abs(metres - sigma[k]) <= 1.3 / 255 / 2 + 1e-6));
});

test("time, flags and words come back as they were", () => {
  const { t, flags, state } = readFrame(frame({ flags: VALID | PAST }), rest);
  assert.deepEqual({ t, flags, state }, {
    t: 1.5e12, flags: VALID | PAST, state: { valid: true, reason: "naïve" },
  });
});

test("a frame without valid input has no positions, only words", () => {
  const empty = encodeFrame({ t: 0, flags: 0, state: { valid: false } });
  const read = readFrame(empty, rest);
  assert.equal(read.position, null);
  assert.equal(read.sigma, null);
  assert.equal(read.state.valid, false);
});

test("each section begins at a multiple of eight bytes, whatever the number of nodes", () => {
  for (let nodes = 1; nodes < 9; nodes += 1) {
    const still = new Float32Array(3 * nodes);
    const moved = Array.from(still, (_, k) => k);
    const spread = Array.from({ length: nodes }, (_, k) => k);
    const read = readFrame(frame({ displacement: moved, sigma: spread }), still);
    assert.ok(Math.abs(read.position.at(-1) - (3 * nodes - 1)) < 1e-3);
    assert.equal(read.state.reason, "naïve");
  }
});

test("a frame of 321 nodes takes less than 17 kB with the state of a whole cage and its lines", async () => {
  const { frameOf } = await import("../dev/state.js");
  const { seaAt } = await import("../dev/cage.js");
  const whole = frameOf({ name: "calm", strength: 1 }, 0, seaAt(0), []);
  assert.ok(whole.byteLength < 17_000, `${whole.byteLength} bytes`);
});

test("what is no frame is refused in words", () => {
  assert.throws(() => readFrame(new ArrayBuffer(100), rest), /begins with SCFR/);
  assert.throws(() => readFrame(new ArrayBuffer(3), rest), /begins with SCFR/);
});

test("a frame of another version asks to load the page again", () => {
  const newer = frame();
  for (const version of [1, 3]) {
    new DataView(newer).setUint16(4, version, true);
    assert.throws(() => readFrame(newer, rest), new RegExp(`version ${version}; this page reads 2`));
  }
});

test("where no spread is known the positions and the words come back, and sigma is null", () => {
  const { flags, position, sigma: none, state } = readFrame(frame({ sigma: null }), rest);
  assert.equal(flags, VALID | IN_DOMAIN | NO_SPREAD);
  assert.equal(none, null);
  assert.ok(Math.abs(position[3] - rest[3] - 40) < 1e-3);
  assert.equal(state.reason, "naïve");
});

test("an empty spread takes no bytes", () => {
  assert.equal(frame().byteLength - frame({ sigma: null }).byteLength, 8);
});

test("a frame for another net is refused", () => {
  assert.throws(() => readFrame(frame(), rest.subarray(3)), /3 nodes does not fit a net of 2/);
});
