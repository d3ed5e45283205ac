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
  of({ bridle, line, sensor, node }) {
    if (node !== undefined) return this.at(this.#node(node));
    if (sensor !== undefined) {
      const found = this.marks.places.find(({ name }) => name === sensor);
      return found ? this.at(found.at) : null;
    }
    const found = this.#lines().find(({ selection }) => (selection.bridle ?? selection.line) === (bridle ?? line));
    if (!found) return null;
    const [from, to] = found.ends;
    return this.at(from.map((one, axis) => one + 0.45 * (to[axis] - one)));
  }

  /** The selection under a pointer's event, or null. */
  under({ clientX, clientY, pointerType }) {
    const box = this.canvas.getBoundingClientRect();
    const nodes = Array.from({ length: this.glide.position.length / 3 },
      (_, k) => this.at(this.#node(k)));
    const lines = this.#lines().map(({ selection, ends }) => {
      const [from, to] = ends.map((place) => this.at(place));
      return { selection, from, to };
    });
    const sensors = this.marks.places.map(({ name, at }) => ({ name, at: this.at(at) }));
    return pick([clientX - box.left, clientY - box.top], { nodes, lines, sensors },
      pointerType === "touch");
  }

  #node = (k) => Array.from(this.glide.position.subarray(3 * k, 3 * k + 3));

  /** All lines with their ends [m]; the bridles' other ends move with the net. */
  #lines() {
    const { bridle_names: names, bridle_nodes: nodes, bridle_corners: corners, corner_position_m: frame,
      lines = [] } = this.topology;
    return [...names.map((bridle, k) => ({ selection: { bridle }, ends: [frame[corners[k]], this.#node(nodes[k])] })),
      ...lines.map(({ name, ends_m: ends }) => ({ selection: { line: name }, ends }))];
  }
}
