// Arrows of the current, at three depths, and of the waves, on the surface.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Vector3 } from "three";

import { SLACK_M_S, towards } from "./geometry.js";

const LENGTH_PER_M_S = 40;
const UP = new Vector3(0, 1, 0);

class Arrow extends Group {
  constructor(material, width) {
    super();
    this.width = width;
    this.shaft = new Mesh(new CylinderGeometry(width, width, 1, 12), material);
    this.head = new Mesh(new ConeGeometry(3 * width, 1, 20), material);
    this.add(this.shaft, this.head);
  }

  /** From a point along a level direction, so long. */
  point(from, [east, north], length) {
    const head = Math.min(9 * this.width, 0.6 * length);
    this.position.set(...from);
    this.quaternion.setFromUnitVectors(UP, new Vector3(east, north, 0));
    this.shaft.scale.set(1, length - head, 1);
    this.shaft.position.set(0, (length - head) / 2, 0);
    this.head.scale.set(1, head, 1);
    this.head.position.set(0, length - head / 2, 0);
  }
}

/** The arrows about one cage: `reach` of the net and its depth [m]. */
export class Arrows extends Group {
  constructor({ reach, depth }) {
    super();
    Object.assign(this, { reach, depth });
    this.water = new MeshBasicMaterial({ transparent: true, opacity: 0.92 });
    this.waves = new MeshBasicMaterial({ transparent: true, opacity: 0.85 });
    this.currents = [0.08, 0.42, 0.8].map((share) =>
      Object.assign(new Arrow(this.water, 0.5), { share }));
    this.wave = new Arrow(this.waves, 0.5);
    this.currentLabel = new Vector3();
    this.waveLabel = new Vector3();
    this.add(...this.currents, this.wave);
  }

  /** Take a state's water; null hides them. */
  follow(water) {
    const speed = water?.current_speed_m_s ?? 0;
    const flows = speed > SLACK_M_S && water.current_to_deg !== null;
    for (const arrow of this.currents) arrow.visible = flows;
    if (flows) {
      const [east, north] = towards(water.current_to_deg);
      const length = Math.min(60, Math.max(7, LENGTH_PER_M_S * speed));
      for (const arrow of this.currents) {
        // Its head stops short of the net.
        const start = this.reach + 5 + length - (arrow.share > 0.6 ? 0.25 * this.reach : 0);
        const z = -arrow.share * this.depth;
        arrow.point([-start * east, -start * north, z], [east, north], length);
        if (arrow !== this.currents[0]) continue;
        this.currentLabel.set(-(start + 5) * east, -(start + 5) * north, z);
      }
    }
    const rolls = (water?.hs_m ?? 0) > 0.05 && (water?.wave_from_deg ?? null) !== null;
    this.wave.visible = rolls;
    if (!rolls) return;
    const [east, north] = towards(water.wave_from_deg);
    const start = this.reach + 26;
    this.wave.point([start * east, start * north, 2.2], [-east, -north], 15);
    this.waveLabel.set((start + 4) * east, (start + 4) * north, 3.5);
  }

  /** Take the theme's colours. */
  dress({ water, wave }) {
    this.water.color.set(water);
    this.waves.color.set(wave);
  }
}
