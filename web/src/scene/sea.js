// The sea around the net: its surface with the waves on it, and the compass upon it.

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments,
  Mesh, PlaneGeometry, ShaderMaterial, Vector2,
} from "three";

import { towards } from "./geometry.js";
import { wavesOf } from "./waves.js";

const VERTEX = `
uniform vec2 along;
uniform float number, height, phase;
varying vec2 vAt;
void main() {
  vAt = position.xy;
  float rise = 0.5 * height * cos(number * dot(along, position.xy) - phase);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position.xy, rise, 1.0);
}`;
const FRAGMENT = `
uniform vec3 water, crest;
uniform vec2 along;
uniform float number, height, phase, radius, strength;
varying vec2 vAt;
void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(vAt) / radius);
  float at = number * dot(along, vAt) - phase;
  // Light on the crests, the more the higher; fine lines along them, sixteen to a wave, as engraved.
  float wavy = step(0.001, height);
  float up = 0.5 + 0.5 * cos(at);
  float swell = wavy * clamp(0.3 + 0.3 * height, 0.0, 1.0) * up * up * up;
  float turn = at * 2.5464791; // sixteen to 2 pi
  float off = abs(fract(turn + 0.5) - 0.5) / max(fwidth(turn), 1e-4);
  float line = wavy * (0.12 + 0.88 * up * up) * (1.0 - smoothstep(0.4, 1.3, off));
  float bright = max(0.8 * swell, line);
  // A little of the crests' colour all over: still water has a surface too.
  gl_FragColor = vec4(mix(water, crest, 0.3 + 0.7 * bright), strength * fade * (0.13 + 0.5 * bright));
  #include <colorspace_fragment>
}`;
const CELL_M = 1.5; // a tenth of the shortest waves that are drawn well

/** The surface; `reach` is the mooring's and `depth` the water's [m]. */
export class Sea extends Group {
  constructor(reach, depth) {
    super();
    const radius = 1.5 * reach;
    const cells = Math.ceil((2 * radius) / CELL_M);
    this.depth = depth;
    this.frequency = 0;
    this.uniforms = {
      along: { value: new Vector2(1, 0) }, number: { value: 0 }, height: { value: 0 },
      phase: { value: 0 }, water: { value: new Color() }, crest: { value: new Color() },
      radius: { value: radius }, strength: { value: 1 },
    };
    this.surface = new Mesh(new PlaneGeometry(2 * radius, 2 * radius, cells, cells), new ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.uniforms, transparent: true,
      depthWrite: false, side: DoubleSide,
    }));
    this.surface.renderOrder = 5;
    this.ring = compass(0.8 * reach);
    this.ringRadius = 0.8 * reach;
    this.add(this.surface, this.ring);
  }

  /** Take the waves of a state's water, crest to trough as high as Hs; flat where they are not known. */
  follow(water) {
    const { along, height, number } = this.uniforms;
    const waves = wavesOf(water, this.depth);
    height.value = waves?.height ?? 0;
    if (!waves) return;
    const [east, north] = towards(waves.from);
    along.value.set(-east, -north);
    number.value = waves.number;
    this.frequency = waves.frequency;
  }

  /** Whether there are waves to move. */
  get rolls() {
    return this.uniforms.height.value > 0;
  }

  /** Let the waves run on, at their phase speed. */
  roll(seconds) {
    const { phase } = this.uniforms;
    phase.value = (phase.value + seconds * this.frequency) % (2 * Math.PI);
  }

  /** Take the theme's colours. */
  dress({ water, crest, ring, dark }) {
    this.uniforms.water.value.set(water);
    this.uniforms.crest.value.set(crest);
    this.uniforms.strength.value = dark ? 1 : 1.5;
    this.ring.material.color.set(ring);
  }
}

/** A ring with a tick every ten degrees, longer every thirty. */
function compass(radius) {
  const points = [];
  for (let degrees = 0; degrees < 360; degrees += 2) {
    const [[x, y], [u, v]] = [towards(degrees), towards(degrees + 2)];
    points.push(radius * x, radius * y, 0, radius * u, radius * v, 0);
    if (degrees % 10) continue;
    const out = radius * (degrees % 90 ? (degrees % 30 ? 1.015 : 1.03) : 1.05);
    points.push(radius * x, radius * y, 0, out * x, out * y, 0);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(points), 3));
  return new LineSegments(geometry,
    new LineBasicMaterial({ transparent: true, opacity: 0.32, depthWrite: false }));
}
