import assert from "node:assert/strict";
import { test } from "node:test";

import { choices, introduced, learnedWords, seaNow } from "../../src/panels/sea-wanted.js";

const current = [{ key: "current_speed_m_s", most: 1.03 }, { key: "current_to_deg" }];
const waves = [{ key: "hs_m", most: 2.5 }, { key: "wave_from_deg" }];

test("only what the twin has learned can be chosen, a little beyond its range", () => {
  const [one, ...others] = choices({ inputs: current });
  assert.deepEqual([one.speed.key, one.speed.least, one.speed.most, one.way.key, others],
    ["current_speed_m_s", 0, 1.29, "current_to_deg", []]);
  assert.equal(learnedWords(one.speed), "learned up to 1.03 m/s");
  assert.deepEqual(choices({ inputs: [...current, ...waves] }).map(({ speed }) => speed.most), [1.29, 3.15]);
});

test("what the twin has not learned is written", () => {
  assert.match(introduced({ inputs: current }), /^Move the current: .*Waves are not among/);
  assert.match(introduced({ inputs: [...current, ...waves] }), /^Move the current and waves: .*period goes/);
});

test("a sea to begin with has no more keys than the twin has inputs, and stays within its sliders", () => {
  const water = { current_speed_m_s: 9, current_to_deg: 359.8, hs_m: 1.23, tp_s: 6, wave_from_deg: null };
  assert.deepEqual(seaNow(choices({ inputs: current }), water), { current_speed_m_s: 1.29, current_to_deg: 0 });
  assert.deepEqual(seaNow(choices({ inputs: waves }), water), { hs_m: 1.25, wave_from_deg: 270 });
  assert.deepEqual(seaNow(choices({ inputs: current }), null), { current_speed_m_s: 0.4, current_to_deg: 90 });
});
