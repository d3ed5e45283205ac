// Where things are on the screen, and what lies under the pointer.

import { Vector3 } from "three";

import { pick } from "./pick.js";

/** The screen of one built scene: of its camera, canvas, topology, glide and marks. */
export class Screen {
  constructor({ camera, canvas, topology, glide, marks }) {
    Object.assign(this, { camera, canvas, topology, glide, marks });
  }

  /** A point of the scene [m] as [x, y, depth] px; null behind the eye. */
  at(place) {
    const point = new Vector3(...place).project(this.camera);
    if (point.z > 1) return null;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return [((point.x + 1) / 2) * width, ((1 - point.y) / 2) * height, point.z];
  }

  /** Where what a selection names is; null where it names nothing in sight. */
  of({ bridle, sensor, node }) {
    if (node !== undefined) return this.at(this.#node(node));
    if (sensor !== undefined) {
      const found = this.marks.places.find(({ name }) => name === sensor);
      return found ? this.at(found.at) : null;
    }
    const k = this.topology.bridle_names.indexOf(bridle);
    if (k < 0) return null;
    const [from, to] = this.#ends(k);
    return this.at(from.map((one, axis) => one + 0.45 * (to[axis] - one)));
  }

  /** The selection under a pointer's event, or null. */
  under({ clientX, clientY, pointerType }) {
    const box = this.canvas.getBoundingClientRect();
    const nodes = Array.from({ length: this.glide.position.length / 3 },
      (_, k) => this.at(this.#node(k)));
    const bridles = this.topology.bridle_names.map((name, k) => {
      const [from, to] = this.#ends(k).map((place) => this.at(place));
      return { name, from, to };
    });
    const sensors = this.marks.places.map(({ name, at }) => ({ name, at: this.at(at) }));
    return pick([clientX - box.left, clientY - box.top], { nodes, bridles, sensors },
      pointerType === "touch");
  }

  #node = (k) => Array.from(this.glide.position.subarray(3 * k, 3 * k + 3));

  #ends(k) {
    const { bridle_nodes: nodes, bridle_corners: corners, corner_position_m: frame } = this.topology;
    return [frame[corners[k]], this.#node(nodes[k])];
  }
}
