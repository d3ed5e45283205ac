// Waves are drawn as the linear theory of water waves has them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { waveNumber, wavesOf } from "../src/scene/waves.js";

const near = (a, b, share) => assert.ok(Math.abs(a - b) <= share * Math.abs(b), `${a} is not ${b}`);

test("a wave number fulfils the dispersion relation in any depth", () => {
  for (const period of [2, 5, 9, 18]) {
    for (const depth of [3, 20, 191, 2000]) {
      const k = waveNumber(period, depth);
      near(9.81 * k * Math.tanh(k * depth), (2 * Math.PI / period) ** 2, 1e-9);
    }
  }
});

test("waves are 1.56 T² long in deep water, and as fast as √(g d) in shallow", () => {
  near((2 * Math.PI) / waveNumber(6, 200), 1.56 * 36, 0.002);
  near((2 * Math.PI / 60) / waveNumber(60, 5), Math.sqrt(9.81 * 5), 0.01);
});

test("without height, period or direction no waves are drawn", () => {
  const water = { hs_m: 1.2, tp_s: 6, wave_from_deg: 270 };
  assert.equal(wavesOf(water, 100).height, 1.2);
  for (const key of Object.keys(water)) assert.equal(wavesOf({ ...water, [key]: null }, 100), null, key);
  assert.equal(wavesOf({ ...water, hs_m: 0 }, 100), null);
  assert.equal(wavesOf(null, 100), null);
});
