// What holds the net: collar, sinker tube, bridles, frame and its buoys.

import {
  BufferAttribute, BufferGeometry, Color, CylinderGeometry, Group, InstancedMesh,
  LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial, Quaternion,
  SphereGeometry, Vector3,
} from "three";

import { ringNodes, smoothLoop, tubeRing } from "./geometry.js";
import { Tube } from "./tube.js";

const PER_SPAN = 3;
const COLLAR = { radius: 0.42, apart: 1.25, rail: 1.15 }; // thicker than true, to be seen [m]
const BRIDLE_RADIUS = 0.32;
const UP = new Vector3(0, 1, 0);

/** The mooring of one topology. */
export class Mooring extends Group {
  constructor(topology) {
    super();
    this.topology = topology;
    this.steel = new MeshStandardMaterial({ roughness: 0.55 });
    this.sinker = new MeshStandardMaterial({ roughness: 0.6 });
    const count = topology.spokes * PER_SPAN;
    this.collar = [0, 1].map(() => new Tube(count, COLLAR.radius, this.steel));
    this.rail = new Tube(count, 0.1, this.steel);
    this.tube = new Tube(count, 0.4, this.sinker);
    this.posts = lines(2 * topology.spokes, 0.8);
    this.#addBridles();
    this.#addFrame();
    this.#addAnchorLines();
    this.add(...this.collar, this.rail, this.posts, this.tube);
    this.follow(topology.rest);
  }

  #addBridles() {
    const { bridle_names: names } = this.topology;
    const cylinder = new CylinderGeometry(BRIDLE_RADIUS, BRIDLE_RADIUS, 1, 10, 1);
    // Unlit: the colour is a number, which shading would change.
    this.bridles = new InstancedMesh(cylinder, new MeshBasicMaterial(), names.length);
    this.bridles.frustumCulled = false;
    this.colours = names.map(() => new Color());
    this.add(this.bridles);
  }

  #addFrame() {
    const corners = this.topology.corner_position_m;
    const frame = lines(4 * corners.length, 0.55);
    const ends = corners.flatMap((corner, k) => [
      corner, corners[(k + 1) % corners.length], corner, [corner[0], corner[1], 0],
    ]);
    frame.geometry.attributes.position.array.set(ends.flat());
    frame.geometry.computeBoundingSphere();
    this.frame = frame;
    this.buoys = new InstancedMesh(new SphereGeometry(1.15, 20, 14),
      new MeshStandardMaterial({ roughness: 0.45 }), corners.length);
    this.plates = new InstancedMesh(new SphereGeometry(0.6, 12, 8), this.steel, corners.length);
    corners.forEach(([x, y, z], k) => {
      this.buoys.setMatrixAt(k, new Matrix4().makeTranslation(x, y, 0.25));
      this.plates.setMatrixAt(k, new Matrix4().makeTranslation(x, y, z));
    });
    this.add(frame, this.buoys, this.plates);
  }

  /** Their upper parts: the rest lies far out and deep. */
  #addAnchorLines() {
    const { lines: known = [] } = this.topology;
    const ends = known.filter(({ kind }) => kind.startsWith("anchor")).flatMap(({ ends_m: its }) => its);
    this.anchors = lines(ends.length, 0.55);
    this.anchors.geometry.attributes.position.array.set(ends.flat());
    // The one that is chosen, of whatever kind but a bridle.
    this.mark = new Mesh(new CylinderGeometry(BRIDLE_RADIUS, BRIDLE_RADIUS, 1, 10, 1), new MeshBasicMaterial());
    this.mark.visible = false;
    this.add(this.anchors, this.mark);
  }

  /** Mark a line of the frame, an anchor or a buoy; none where it has no such name. */
  point(name) {
    const found = this.topology.lines?.find((one) => one.name === name);
    this.mark.visible = Boolean(found);
    if (found) this.mark.matrix.copy(between(...found.ends_m.map((end) => new Vector3(...end)), 1.4));
    this.mark.matrixAutoUpdate = false;
  }

  /** Follow the net's nodes. */
  follow(position) {
    const { topology } = this;
    const at = (node) => [position[3 * node], position[3 * node + 1], position[3 * node + 2]];
    const ring = ringNodes(topology, 0).map(at);
    const middle = [0, 1].map((axis) =>
      ring.reduce((sum, one) => sum + one[axis], 0) / ring.length);
    const widened = (by, up) => ring.map(([x, y, z]) => {
      const away = Math.hypot(x - middle[0], y - middle[1]);
      return [x + (by * (x - middle[0])) / away, y + (by * (y - middle[1])) / away, z + up];
    });
    const [outer, rail] = [widened(COLLAR.apart, 0.1), widened(0.2, COLLAR.rail)];
    this.collar[0].follow(smoothLoop(widened(0, 0.1), PER_SPAN));
    this.collar[1].follow(smoothLoop(outer, PER_SPAN));
    this.rail.follow(smoothLoop(rail, PER_SPAN));
    this.tube.follow(smoothLoop(ringNodes(topology, tubeRing(topology)).map(at), PER_SPAN));
    this.posts.geometry.attributes.position.array.set(
      ring.flatMap((_, k) => [...outer[k], ...rail[k]]));
    this.posts.geometry.attributes.position.needsUpdate = true;
    this.posts.geometry.computeBoundingSphere();
    topology.bridle_names.forEach((_, k) => this.#stretch(k, at(topology.bridle_nodes[k])));
    this.bridles.instanceMatrix.needsUpdate = true;
  }

  #stretch(k, end) {
    const from = new Vector3(...this.topology.corner_position_m[this.topology.bridle_corners[k]]);
    this.bridles.setMatrixAt(k, between(from, new Vector3(...end), this.chosen === k ? 1.9 : 1));
  }

  /** Colour the bridles, and thicken the one that is chosen (-1: none). */
  paint(colours, chosen) {
    this.chosen = chosen;
    colours.forEach((colour, k) => this.bridles.setColorAt(k, this.colours[k].set(colour)));
    this.bridles.instanceColor.needsUpdate = true;
  }

  /** Take the theme's colours. */
  dress({ collar, rope, buoy, chosen }) {
    this.steel.color.set(collar);
    this.sinker.color.set(rope);
    this.buoys.material.color.set(buoy);
    for (const one of [this.frame, this.posts, this.anchors]) one.material.color.set(rope);
    this.mark.material.color.set(chosen);
  }
}

/** Where a cylinder of unit length stands between two points, so many times as wide. */
function between(from, to, wide) {
  const along = to.clone().sub(from);
  return new Matrix4().compose(from.clone().addScaledVector(along, 0.5),
    new Quaternion().setFromUnitVectors(UP, along.clone().normalize()), new Vector3(wide, along.length(), wide));
}

function lines(points, opacity) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * points), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ transparent: true, opacity }));
}
