// What lies under the pointer, found on the screen: whatever is nearest and in front.

const FINE_PX = 13;
const COARSE_PX = 24;

/**
 * Find it.
 *
 * @param {[number, number]} pointer on the canvas [px]
 * @param {{sensors, lines, nodes}} things on the screen: sensors [{name, at}], lines
 *   [{selection, from, to}], nodes [at]; `at` is [x, y, depth] in px, depth growing away, or null
 *   where it is behind the eye
 * @param {boolean} coarse whether a finger points
 * @returns a selection for the model, or null
 */
export function pick(pointer, { sensors, lines, nodes }, coarse) {
  const near = coarse ? COARSE_PX : FINE_PX;
  const sensor = nearest(sensors, ({ at }) => distance(pointer, at), near + 3);
  if (sensor) return { sensor: sensor.name };
  const line = nearest(lines, ({ from, to }) => toSegment(pointer, from, to), 0.65 * near);
  const [node, off] = frontNode(pointer, nodes, near);
  if (line && !(off < 4)) return line.selection;
  return node === null ? null : { node };
}

function nearest(things, far, limit) {
  let [best, least] = [null, limit];
  for (const thing of things) {
    const away = far(thing);
    if (away < least) [best, least] = [thing, away];
  }
  return best;
}

/** Of the nodes near the pointer the one in front; the net is seen through. */
function frontNode(pointer, nodes, near) {
  let [best, off, front] = [null, Infinity, Infinity];
  nodes.forEach((at, k) => {
    const away = distance(pointer, at);
    if (away < near && at[2] < front) [best, off, front] = [k, away, at[2]];
  });
  return [best, off];
}

const distance = ([x, y], at) => (at ? Math.hypot(at[0] - x, at[1] - y) : Infinity);

/** How far a point is from a segment [px]. */
export function toSegment([x, y], from, to) {
  if (!from || !to) return Infinity;
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const along = ((x - from[0]) * dx + (y - from[1]) * dy) / (dx * dx + dy * dy || 1);
  const share = Math.min(1, Math.max(0, along));
  return Math.hypot(from[0] + share * dx - x, from[1] + share * dy - y);
}
