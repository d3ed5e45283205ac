// The net's outline as it is seen from the side, and the band in which it may be.

import { nodeNormals, ringNodes, triangles } from "./geometry.js";

const SIGMAS = 2;

/** The net moved outwards by so many times its sigma, node by node. */
export function widened(topology, position, sigma, times) {
  const normal = nodeNormals(position, triangles(topology), new Float32Array(position.length));
  return position.map((metres, k) => metres + times * sigma[Math.floor(k / 3)] * normal[k]);
}

/** The outline of a net seen from the side: down its left, to the tip, and up its right. */
export function outline(topology, position, project) {
  const { rings, spokes } = topology;
  const at = (node) => project([0, 1, 2].map((axis) => position[3 * node + axis]));
  const [left, right] = [[], []];
  for (let ring = 0; ring < rings; ring += 1) {
    const seen = ringNodes(topology, ring).map(at);
    left.push(seen.reduce((a, b) => (b[0] < a[0] ? b : a)));
    right.unshift(seen.reduce((a, b) => (b[0] > a[0] ? b : a)));
  }
  return [...left, at(rings * spokes), ...right];
}

/** The band of plus and minus two sigma: its outer and its inner line, as `line` gives them. */
export const band = (topology, position, sigma, line) =>
  [SIGMAS, -SIGMAS].map((times) => line(widened(topology, position, sigma, times)));
