// The cage in three dimensions, drawn when something changes.

import {
  DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
} from "three";

import { make, still } from "../dom.js";
import { linesOf, selectionOf } from "../lines.js";
import { text } from "../texts/index.js";
import { onTheme, styled, theme } from "../theme.js";
import { Arrows } from "./arrows.js";
import { extent } from "./geometry.js";
import { Glide } from "./glide.js";
import { Marks } from "./marks.js";
import { Mooring } from "./mooring.js";
import { Net } from "./net.js";
import { Orbit } from "./orbit.js";
import { Overlay } from "./overlay.js";
import { bridleColours, netColours, sensorColour, tintOf } from "./paint.js";
import { Screen } from "./screen.js";
import { Sea } from "./sea.js";

const ROLL_MS = 50; // twenty pictures a second are enough for a swell
const SLOW = /swiftshader|llvmpipe|software/i;
const VIEWS = {
  oblique: { azimuth: 0.38, elevation: 0.3 },
  side: { azimuth: 0, elevation: 0.02 },
  top: { azimuth: 0, elevation: Math.PI / 2 - 1e-3 },
};

/** One view of a model's cage. */
export class View3d {
  constructor(model, options, holder) {
    Object.assign(this, { model, options, holder });
    this.canvas = make("canvas", {
      id: "net", tabIndex: 0, role: "img",
      "aria-label": text("scene.canvas"),
    });
    holder.append(this.canvas);
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.camera = new PerspectiveCamera(34, 1, 2, 1500);
    this.scene = new Scene();
    this.sky = new HemisphereLight(0xffffff, 0x24445c, 1.9);
    this.sky.position.set(0, 0, 1);
    this.sun = new DirectionalLight(0xffffff, 1.5);
    this.sun.position.set(-60, -80, 120);
    this.scene.add(this.sky, this.sun);
    this.overlay = new Overlay(holder, { lookNorth: () => this.orbit.look({ azimuth: 0 }) });
    this.orbit = new Orbit(this.camera, this.canvas, () => this.wake());
    this.frames = 0;
    this.moves = !SLOW.test(rendererName(this.renderer));
    this.forget = [
      model.on("topology", (topology) => this.build(topology)),
      model.on("view", (view) => this.show(view)),
      model.on("selection", () => this.repaint()),
      onTheme(() => this.dress()),
      options.on((name) => this.optionChanged(name)),
    ];
    this.listen();
    this.resizing = new ResizeObserver(() => this.resize());
    this.resizing.observe(holder);
    if (model.topology) this.build(model.topology);
    if (model.view) this.show(model.view);
  }

  listen() {
    const { canvas } = this;
    canvas.addEventListener("pointermove", (event) => this.hover(event));
    canvas.addEventListener("pointerleave", () => this.point(null));
    canvas.addEventListener("click", (event) => {
      if (!this.orbit.dragged) this.model.select(this.screen?.under(event) ?? null);
    });
    canvas.addEventListener("dblclick", () => this.look("oblique"));
    canvas.addEventListener("keydown", (event) => this.key(event));
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => this.wake());
  }

  // --- what is there ---

  build(topology) {
    this.clear();
    const size = extent(topology);
    Object.assign(this, { topology, size });
    this.glide = new Glide(topology.rest);
    this.net = new Net(topology);
    this.mooring = new Mooring(topology);
    this.marks = new Marks(topology);
    this.arrows = new Arrows(size);
    this.sea = new Sea(size.frame, topology.water_depth_m);
    this.screen = new Screen(this);
    this.parts = [this.net, this.mooring, this.marks, this.arrows, this.sea];
    this.scene.add(...this.parts);
    this.applyOptions();
    this.dress();
    this.resize();
    this.look("oblique", { atOnce: true });
  }

  clear() {
    for (const part of this.parts ?? []) {
      this.scene.remove(part);
      part.traverse((one) => {
        one.geometry?.dispose();
        one.material?.dispose();
        if (one.isInstancedMesh) one.dispose();
      });
    }
    this.parts = [];
  }

  show(view) {
    if (!this.topology) return;
    this.shown = view;
    this.glide.aim(view.position, view.sigma, performance.now());
    this.envelop();
    const water = view.state.valid ? view.state.water : null;
    this.arrows.follow(water);
    this.sea.follow(water);
    this.repaint();
    this.gliding = true;
  }

  applyOptions() {
    const { ghost, sea } = this.options;
    this.net.ghost.visible = ghost;
    this.sea.surface.visible = sea;
    this.envelop();
  }

  /** Show where the net may be, where that is chosen and known. */
  envelop() {
    this.net.shell.visible = this.options.shell && Boolean(this.shown?.sigma);
  }

  optionChanged(name) {
    if (!this.topology) return;
    this.applyOptions();
    if (name === "shell") this.gliding = true;
    this.repaint();
  }

  // --- colours ---

  dress() {
    if (!this.topology) return;
    const dark = theme() === "dark";
    const [twine, ghost, collar, rope, buoy] =
      ["--twine", "--ghost", "--collar", "--rope", "--buoy"].map(styled);
    this.net.dress({ twine, ghost, shell: styled("--envelope"), dark });
    this.mooring.dress({ collar, rope, buoy, chosen: styled("--focus") });
    this.arrows.dress({ water: styled("--water"), wave: styled("--wave") });
    this.sea.dress({ water: styled("--sea-0"), crest: styled("--crest"), ring: ghost, dark });
    this.sky.intensity = dark ? 1.9 : 2.4;
    this.repaint();
  }

  repaint() {
    if (!this.topology) return;
    const { topology, shown: view, options } = this;
    const pointed = this.pointed ?? this.model.selection ?? {};
    const bridle = topology.bridle_names.indexOf(pointed.bridle);
    this.mooring.paint(bridleColours(topology, view, options), bridle);
    this.mooring.point(pointed.line);
    this.marks.paint((name) => sensorColour(view, name), pointed.sensor);
    this.net.paint(netColours(topology, tintOf(topology, view, options), options));
    this.mooring.follow(this.glide.position);
    this.marks.follow(this.glide.position);
    this.wake();
  }

  // --- the picture ---

  /** Draw soon. */
  wake() {
    this.requested ??= requestAnimationFrame((now) => {
      this.requested = undefined;
      this.step(now);
    });
  }

  step(now) {
    if (!this.topology || !this.canvas.isConnected) return;
    const seconds = Math.min(0.1, (now - (this.before ?? now)) / 1000);
    this.before = now;
    const turning = this.orbit.step(seconds || 0.016);
    if (this.gliding) {
      this.gliding = this.glide.step(performance.now());
      this.net.follow(this.glide.position, this.glide.sigma);
      this.mooring.follow(this.glide.position);
      this.marks.follow(this.glide.position);
    }
    this.draw(now);
    if (turning || this.gliding) this.wake();
    else this.rest(now);
  }

  /** Between pictures: the swell alone, where the machine and the reader allow it. */
  rest(now) {
    const rolls = this.moves && this.options.sea && this.sea.rolls && !still() && !document.hidden;
    clearTimeout(this.rolling);
    if (rolls) this.rolling = setTimeout(() => this.wake(), ROLL_MS);
    else this.before = undefined;
    this.rolledAt = now;
  }

  draw(now) {
    if (this.moves && !still()) this.sea.roll(Math.min(0.1, (now - (this.drawnAt ?? now)) / 1000));
    this.drawnAt = now;
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
    this.canvas.dataset.frames = this.frames; // what tests wait for
    this.canvas.dataset.bottom = this.glide.position.at(-1).toFixed(3);
    this.overlay.show(this);
  }

  // --- the reader ---

  hover(event) {
    if (this.orbit.dragging || event.pointerType === "touch") return;
    this.point(this.screen?.under(event) ?? null);
  }

  point(selection) {
    if (JSON.stringify(selection) === JSON.stringify(this.pointed ?? null)) return;
    this.pointed = selection;
    this.canvas.classList.toggle("pointing", Boolean(selection));
    this.repaint();
  }

  key(event) {
    if (event.key === "Escape") this.model.select(null);
    if (event.key === "Home") this.look("oblique");
    const step = { PageDown: 1, PageUp: -1 }[event.key];
    if (!step || !this.screen) return;
    event.preventDefault();
    const all = [...linesOf(this.topology).map(({ name }) => selectionOf(this.topology, name)),
      ...this.marks.places.map(({ name }) => ({ sensor: name }))];
    const at = all.findIndex((one) => JSON.stringify(one) === JSON.stringify(this.model.selection));
    const next = at < 0 && step < 0 ? all.length - 1 : at + step;
    this.model.select(all[(next + all.length) % all.length]);
  }

  /** Look from a named side. */
  look(name, how) {
    if (!this.size) return;
    const [width, height] = [this.holder.clientWidth || 1, this.holder.clientHeight || 1];
    // All of the frame fits the narrower way.
    const wide = Math.max(1, (1.38 * height) / width);
    const target = new Vector3(0, 0, name === "top" ? 0 : -0.3 * this.size.depth);
    const distance = (name === "top" ? 3.1 : 2.6) * this.size.frame * wide;
    const farthest = 8 * this.size.frame;
    this.orbit.limits = [0.5 * this.size.frame, farthest];
    this.orbit.look({ ...VIEWS[name], target, distance: Math.min(distance, farthest) }, how);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.wake();
  }

  /** Leave nothing behind. */
  close() {
    for (const stop of this.forget) stop();
    this.resizing.disconnect();
    clearTimeout(this.rolling);
    this.clear();
    this.renderer.dispose();
    this.holder.replaceChildren();
  }
}

function rendererName(renderer) {
  const gl = renderer.getContext();
  const named = gl.getExtension("WEBGL_debug_renderer_info");
  return named ? String(gl.getParameter(named.UNMASKED_RENDERER_WEBGL)) : "";
}
