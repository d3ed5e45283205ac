// What lies over the three-dimensional drawing, moved along with it.

import { chosenLine } from "../lines.js";
import { bearing, compass as compassPoint, known, withUnit } from "../panels/format.js";
import { text } from "../texts/index.js";
import { compass, Labels, scaleBar } from "./furniture.js";
import { towards } from "./geometry.js";
import { Tip } from "./tip.js";
import { wordsFor } from "./words.js";

const POINTS = { N: 0, E: 90, S: 180, W: 270 }; // names of classes, too
const OUTSIDE = 1.08; // the ring of the compass

export class Overlay {
  constructor(holder, { lookNorth }) {
    this.labels = new Labels(holder);
    this.tip = new Tip(holder);
    this.compass = compass(lookNorth);
    this.scale = scaleBar();
    holder.append(this.compass.element, this.scale.element);
  }

  /** Follow a view: its camera, its water, and what is pointed at. */
  show(view) {
    this.#names(view);
    this.#water(view);
    const { distance, azimuth } = view.orbit.now;
    const halfView = Math.tan((view.camera.fov * Math.PI) / 360);
    this.compass.turn((azimuth * 180) / Math.PI);
    this.scale.show(view.canvas.clientHeight / (2 * distance * halfView));
    const { selection } = view.model;
    const target = view.pointed ?? (chosenLine(selection) ? null : selection); // which has its own panel
    this.tip.show(wordsFor(target, view.topology, view.shown), target && view.screen.of(target));
  }

  #names({ sea, screen }) {
    for (const [name, degrees] of Object.entries(POINTS)) {
      const [x, y] = towards(degrees).map((one) => OUTSIDE * sea.ringRadius * one);
      this.labels.pin(`point-${name}`, compassPoint(degrees), screen.at([x, y, 0]));
    }
  }

  #water({ arrows, screen, shown }) {
    const water = shown?.state.valid ? shown.state.water : null;
    const pin = (name, arrow, place, words) =>
      this.labels.pin(name, words, water && arrow.visible ? screen.at(place.toArray()) : null);
    pin("current", arrows.currents[0], arrows.currentLabel, water && text("scene.current",
      { speed: withUnit(water.current_speed_m_s, "m/s", 2), direction: bearing(water.current_to_deg) }));
    pin("waves", arrows.wave, arrows.waveLabel, water && text("scene.waves",
      { height: [withUnit(water.hs_m, "m"), known(water.tp_s) && withUnit(water.tp_s, "s")].filter(Boolean).join(", "),
        direction: bearing(water.wave_from_deg) }));
  }
}
