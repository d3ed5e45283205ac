// The sensors on the net and its bridles, as marks.

import {
  Color, Group, InstancedMesh, Matrix4, MeshBasicMaterial, OctahedronGeometry, SphereGeometry,
} from "three";

import { sensorPlaces } from "./places.js";

/** Balls for depth sensors, octahedra for shackles. */
export class Marks extends Group {
  constructor(topology) {
    super();
    this.topology = topology;
    const material = new MeshBasicMaterial();
    this.balls = new InstancedMesh(new SphereGeometry(0.95, 18, 12), material,
      topology.depth_sensors.length);
    this.gems = new InstancedMesh(new OctahedronGeometry(1.15), material, topology.shackles.length);
    for (const one of [this.balls, this.gems]) one.frustumCulled = false;
    this.add(this.balls, this.gems);
    this.follow(topology.rest);
  }

  /** Follow the net's nodes. */
  follow(position) {
    this.places = sensorPlaces(this.topology, position);
    this.places.forEach(({ at, name }, k) => {
      const size = name === this.chosen ? 1.6 : 1;
      this.#of(k).setMatrixAt(this.#index(k), new Matrix4().makeTranslation(...at)
        .scale({ x: size, y: size, z: size }));
    });
    for (const one of [this.balls, this.gems]) one.instanceMatrix.needsUpdate = true;
  }

  /** Colour each by its name. */
  paint(colourOf, chosen) {
    this.chosen = chosen;
    this.places.forEach(({ name }, k) =>
      this.#of(k).setColorAt(this.#index(k), new Color(colourOf(name))));
    for (const one of [this.balls, this.gems]) {
      if (one.instanceColor) one.instanceColor.needsUpdate = true;
    }
  }

  #of = (k) => (k < this.balls.count ? this.balls : this.gems);

  #index = (k) => (k < this.balls.count ? k : k - this.balls.count);
}
