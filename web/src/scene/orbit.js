// The camera, turned about the cage by pointer, touch and keyboard.

import { MathUtils, Vector3 } from "three";

import { still } from "../dom.js";

const LOWEST = MathUtils.degToRad(-60);
const HIGHEST = MathUtils.degToRad(89.9);
const EASE_PER_S = 9;
const KEYS = {
  ArrowLeft: { azimuth: 0.12 }, ArrowRight: { azimuth: -0.12 },
  ArrowUp: { elevation: 0.08 }, ArrowDown: { elevation: -0.08 },
  "+": { zoom: 0.87 }, "=": { zoom: 0.87 }, "-": { zoom: 1.15 },
};

/** Turns a camera about a point; `changed` is called when it has to be drawn again. */
export class Orbit {
  constructor(camera, element, changed) {
    Object.assign(this, { camera, element, changed });
    this.wanted = { azimuth: 0.6, elevation: 0.25, distance: 150, target: new Vector3(0, 0, -12) };
    this.now = { ...this.wanted, target: this.wanted.target.clone() };
    this.limits = [30, 500];
    this.pointers = new Map();
    const listen = (name, fn, how) => element.addEventListener(name, fn, how);
    listen("pointerdown", (event) => this.#down(event));
    listen("pointermove", (event) => this.#move(event));
    for (const name of ["pointerup", "pointercancel"]) listen(name, (event) => this.#up(event));
    listen("wheel", (event) => this.#wheel(event), { passive: false });
    listen("keydown", (event) => this.#key(event));
    listen("contextmenu", (event) => event.preventDefault());
  }

  /** Whether a drag is under way, so that nobody looks for what lies under the pointer. */
  get dragging() {
    return this.pointers.size > 0 && this.dragged;
  }

  /** Look from here; at once where the reader wants no motion. */
  look(view, { atOnce = false } = {}) {
    Object.assign(this.wanted, view);
    if (view.azimuth !== undefined) {
      // The short way round.
      const turn = 2 * Math.PI;
      this.now.azimuth += turn * Math.round((view.azimuth - this.now.azimuth) / turn);
    }
    if (atOnce || still()) {
      Object.assign(this.now, this.wanted, { target: this.wanted.target.clone() });
    }
    this.changed();
  }

  /** Move the camera on by some seconds; whether it still moves. */
  step(seconds) {
    const share = still() ? 1 : 1 - Math.exp(-EASE_PER_S * seconds);
    let left = 0;
    for (const key of ["azimuth", "elevation", "distance"]) {
      const gap = this.wanted[key] - this.now[key];
      this.now[key] += share * gap;
      left = Math.max(left, Math.abs(gap) / (key === "distance" ? this.wanted.distance : 1));
    }
    this.now.target.lerp(this.wanted.target, share);
    left = Math.max(left, this.now.target.distanceTo(this.wanted.target) / this.wanted.distance);
    this.#place();
    return left > 5e-4;
  }

  #place() {
    const { azimuth, elevation, distance, target } = this.now;
    const flat = distance * Math.cos(elevation);
    this.camera.position.set(
      target.x + flat * Math.sin(azimuth), target.y - flat * Math.cos(azimuth),
      target.z + distance * Math.sin(elevation));
    this.camera.up.set(0, 0, 1);
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
  }

  #turn(azimuth, elevation) {
    this.wanted.azimuth += azimuth;
    this.wanted.elevation = MathUtils.clamp(this.wanted.elevation + elevation, LOWEST, HIGHEST);
    this.changed();
  }

  zoom(factor) {
    this.wanted.distance = MathUtils.clamp(this.wanted.distance * factor, ...this.limits);
    this.changed();
  }

  #pan(right, up) {
    const scale = (2 * this.now.distance * Math.tan(MathUtils.degToRad(this.camera.fov / 2)))
      / this.element.clientHeight;
    const { elements: m } = this.camera.matrixWorld;
    this.wanted.target = this.wanted.target.clone()
      .addScaledVector(new Vector3(m[0], m[1], m[2]), -right * scale)
      .addScaledVector(new Vector3(m[4], m[5], m[6]), up * scale);
    this.wanted.target.clampLength(0, 120);
    this.changed();
  }

  #down(event) {
    this.element.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.pans = event.button === 2 || event.button === 1 || event.shiftKey;
    this.dragged = false;
    this.travelled = 0;
  }

  #move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const [dx, dy] = [event.clientX - before[0], event.clientY - before[1]];
    this.travelled += Math.abs(dx) + Math.abs(dy);
    if (this.travelled > 4) this.dragged = true;
    if (others.length) {
      const apart = (at) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]) || 1;
      this.zoom(apart(before) / apart([event.clientX, event.clientY]));
      this.#pan(dx / 2, dy / 2);
    } else if (this.pans) this.#pan(dx, dy);
    else this.#turn(-0.006 * dx, 0.005 * dy);
  }

  #up(event) {
    this.pointers.delete(event.pointerId);
  }

  #wheel(event) {
    event.preventDefault();
    const by = event.deltaY * (event.deltaMode ? 30 : 1);
    this.zoom(Math.exp(0.0012 * MathUtils.clamp(by, -300, 300)));
  }

  #key(event) {
    const does = KEYS[event.key];
    if (!does || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation(); // the page has other uses for arrows
    if (does.zoom) this.zoom(does.zoom);
    else if (event.shiftKey) this.#pan(150 * (does.azimuth ?? 0), 150 * (does.elevation ?? 0));
    else this.#turn(does.azimuth ?? 0, does.elevation ?? 0);
  }
}
