// A round tube along a closed or open curve, whose points are written in place.

import { BufferAttribute, BufferGeometry, Mesh } from "three";

const SIDES = 8;

/** A mesh whose `follow(points)` moves it; the number of points never changes. */
export class Tube extends Mesh {
  constructor(count, radius, material, { closed = true } = {}) {
    const geometry = new BufferGeometry();
    for (const name of ["position", "normal"]) {
      geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * count * SIDES), 3));
    }
    const index = [];
    for (let k = 0; k < (closed ? count : count - 1); k += 1) {
      for (let j = 0; j < SIDES; j += 1) {
        const [a, b] = [k * SIDES, ((k + 1) % count) * SIDES];
        const next = (j + 1) % SIDES;
        index.push(a + j, b + j, b + next, a + j, b + next, a + next);
      }
    }
    geometry.setIndex(index);
    super(geometry, material);
    Object.assign(this, { count, radius, closed });
  }

  follow(points) {
    const { position, normal } = this.geometry.attributes;
    for (let k = 0; k < this.count; k += 1) {
      const before = points[this.closed ? (k - 1 + this.count) % this.count : Math.max(0, k - 1)];
      const after = points[this.closed ? (k + 1) % this.count : Math.min(this.count - 1, k + 1)];
      const along = unit([0, 1, 2].map((axis) => after[axis] - before[axis]));
      // Across: level, unless the tube is upright.
      const across = Math.abs(along[2]) > 0.99 ? [1, 0, 0] : unit([along[1], -along[0], 0]);
      const up = cross(across, along);
      for (let j = 0; j < SIDES; j += 1) {
        const turn = (2 * Math.PI * j) / SIDES;
        const [c, s] = [Math.cos(turn), Math.sin(turn)];
        const at = 3 * (k * SIDES + j);
        for (let axis = 0; axis < 3; axis += 1) {
          const out = c * across[axis] + s * up[axis];
          normal.array[at + axis] = out;
          position.array[at + axis] = points[k][axis] + this.radius * out;
        }
      }
    }
    position.needsUpdate = true;
    normal.needsUpdate = true;
    this.geometry.computeBoundingSphere();
  }
}

const unit = (v) => {
  const length = Math.hypot(...v) || 1;
  return v.map((one) => one / length);
};
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
