// A scale that all see at once and that does not jump with every reading.

const RINGS = new Map([
  [0.1, 2], [0.2, 4], [0.3, 3], [0.5, 5], [0.75, 3], [1, 4], [1.5, 3], [2, 4], [3, 3], [5, 5],
]);
const STEPS = [...RINGS.keys()];
const SHRINK = 0.85; // of a smaller scale: below it the smaller one is taken

/** The end of the scale for a largest share, near the one in use. */
export function scaleFor(largest, present = STEPS[0]) {
  const wanted = STEPS.find((step) => step >= largest) ?? STEPS.at(-1);
  if (wanted >= present) return wanted;
  return STEPS.find((step) => SHRINK * step >= largest) ?? present;
}

/** Where the rings of a scale are, the last at its end. */
export function ringsOf(end) {
  const count = RINGS.get(end);
  return Array.from({ length: count }, (_, k) => (end * (k + 1)) / count);
}
