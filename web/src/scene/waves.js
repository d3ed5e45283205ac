// Linear waves: as long, as high and as fast as the state of the sea says.

const GRAVITY = 9.81; // [m/s²]
const LEAST_M = 0.05; // of the height: below it the sea is flat
const STEPS = 20; // of Newton's method, which needs five

/** Angular wave number of a period in water of a depth: ω² = g k tanh(k d) [rad/m]. */
export function waveNumber(period, depth) {
  const deep = (2 * Math.PI / period) ** 2 / GRAVITY;
  let k = deep / Math.sqrt(Math.tanh(deep * depth));
  for (let step = 0; step < STEPS; step += 1) {
    const t = Math.tanh(k * depth);
    k -= (k * t - deep) / (t + k * depth * (1 - t * t));
  }
  return k;
}

/**
 * The waves of a state's water: {height, number, frequency, from}, in m, rad/m, rad/s and compass
 * degrees; null where height, period or direction is not known, and where there are none.
 */
export function wavesOf(water, depth) {
  const { hs_m: height, tp_s: period, wave_from_deg: from } = water ?? {};
  if (![height, period, from].every(Number.isFinite) || height < LEAST_M || period <= 0) return null;
  return { height, from, frequency: (2 * Math.PI) / period, number: waveNumber(period, depth) };
}
