// The net's geometry, as arrays: what the drawings in three and in two dimensions share.

/** Below it the direction of a current says nothing [m/s]. */
export const SLACK_M_S = 0.03;

/** Triangles of the net, counter-clockwise seen from outside: rings × spokes and a tip. */
export function triangles({ rings, spokes }) {
  const found = [];
  const tip = rings * spokes;
  for (let ring = 0; ring < rings; ring += 1) {
    for (let k = 0; k < spokes; k += 1) {
      const [a, b] = [ring * spokes + k, ring * spokes + ((k + 1) % spokes)];
      if (ring + 1 === rings) found.push(a, tip, b);
      else found.push(a, a + spokes, b + spokes, a, b + spokes, b);
    }
  }
  return Uint16Array.from(found);
}

/** The nodes of a ring, 0 at the collar. */
export const ringNodes = ({ spokes }, ring) =>
  Array.from({ length: spokes }, (_, k) => ring * spokes + k);

/** The ring on the cylinder's lower edge, which carries the sinker tube. */
export function tubeRing({ rings, spokes, rest }) {
  const radius = (ring) => Math.hypot(rest[3 * ring * spokes], rest[3 * ring * spokes + 1]);
  let last = 0;
  while (last + 1 < rings && radius(last + 1) > 0.99 * radius(0)) last += 1;
  return last;
}

/** Widest reach of the net and its mooring from the middle, and its greatest depth [m]. */
export function extent({ rest, corner_position_m: corners }) {
  let [reach, depth] = [0, 0];
  for (let k = 0; k < rest.length; k += 3) {
    reach = Math.max(reach, Math.hypot(rest[k], rest[k + 1]));
    depth = Math.max(depth, -rest[k + 2]);
  }
  const frame = Math.max(reach, ...corners.map(([x, y]) => Math.hypot(x, y)));
  return { reach, depth, frame };
}

/** Normals of the nodes, outwards, into `out`: of the triangles around each, by area. */
export function nodeNormals(position, index, out) {
  out.fill(0);
  for (let k = 0; k < index.length; k += 3) {
    const [a, b, c] = [3 * index[k], 3 * index[k + 1], 3 * index[k + 2]];
    const [ux, uy, uz] = [0, 1, 2].map((axis) => position[b + axis] - position[a + axis]);
    const [vx, vy, vz] = [0, 1, 2].map((axis) => position[c + axis] - position[a + axis]);
    const normal = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const corner of [a, b, c]) {
      for (let axis = 0; axis < 3; axis += 1) out[corner + axis] += normal[axis];
    }
  }
  for (let k = 0; k < out.length; k += 3) {
    const length = Math.hypot(out[k], out[k + 1], out[k + 2]) || 1;
    for (let axis = 0; axis < 3; axis += 1) out[k + axis] /= length;
  }
  return out;
}

/** Distance of each node from where it hangs in still water [m]. */
export function movedBy(position, rest) {
  return Float32Array.from({ length: rest.length / 3 }, (_, k) => Math.hypot(
    position[3 * k] - rest[3 * k], position[3 * k + 1] - rest[3 * k + 1],
    position[3 * k + 2] - rest[3 * k + 2]));
}

/** A closed curve through points [x, y, z], so many points per span (Catmull-Rom). */
export function smoothLoop(points, perSpan) {
  const curve = [];
  const count = points.length;
  for (let k = 0; k < count; k += 1) {
    const [p, q, r, s] = [k - 1, k, k + 1, k + 2].map((at) => points[(at + count) % count]);
    for (let j = 0; j < perSpan; j += 1) {
      const t = j / perSpan;
      curve.push(q.map((_, axis) => 0.5 * (2 * q[axis] + (r[axis] - p[axis]) * t
        + (2 * p[axis] - 5 * q[axis] + 4 * r[axis] - s[axis]) * t * t
        + (3 * q[axis] - p[axis] - 3 * r[axis] + s[axis]) * t ** 3)));
    }
  }
  return curve;
}

/** Compass bearing of a horizontal vector [deg]. */
export const bearingOf = (x, y) => ((Math.atan2(x, y) * 180) / Math.PI + 360) % 360;

/** Unit vector towards a compass bearing [deg]: east, north. */
export function towards(bearing) {
  const turn = (bearing * Math.PI) / 180;
  return [Math.sin(turn), Math.cos(turn)];
}
