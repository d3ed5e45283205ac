// The sea around the net: its surface with the waves' crests, and the compass upon it.

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments,
  Mesh, PlaneGeometry, ShaderMaterial, Vector2,
} from "three";

import { towards } from "./geometry.js";

const GRAVITY = 9.81;
const VERTEX = `
uniform vec2 along;
uniform float number, height, phase;
varying vec2 vAt;
varying float vCrest;
void main() {
  vAt = position.xy;
  float at = dot(along, position.xy) * number - phase;
  // A second, longer and slanting train keeps the crests from looking ruled.
  vec2 askew = vec2(along.x * 0.95 - along.y * 0.31, along.x * 0.31 + along.y * 0.95);
  float slant = dot(askew, position.xy);
  vCrest = 0.8 * sin(at) + 0.2 * sin(0.6 * slant * number - 0.77 * phase);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position.xy, 0.5 * height * vCrest, 1.0);
}`;
const FRAGMENT = `
uniform vec3 water, crest;
uniform float radius, height, strength;
varying vec2 vAt;
varying float vCrest;
void main() {
  float away = length(vAt) / radius;
  float fade = 1.0 - smoothstep(0.35, 1.0, away);
  float rough = (0.35 + 0.65 * clamp(height, 0.0, 1.5)) * step(0.05, height);
  float bright = rough * pow(0.5 + 0.5 * vCrest, 5.0);
  // A little of the crests' colour all over: still water has a surface too.
  gl_FragColor = vec4(mix(water, crest, 0.3 + 0.5 * bright), strength * fade * (0.16 + 0.3 * bright));
  #include <colorspace_fragment>
}`;

/** The surface; `reach` is the mooring's [m]. */
export class Sea extends Group {
  constructor(reach) {
    super();
    const radius = 1.5 * reach;
    this.uniforms = {
      along: { value: new Vector2(1, 0) }, number: { value: 0.2 }, height: { value: 0 },
      phase: { value: 0 }, water: { value: new Color() }, crest: { value: new Color() },
      radius: { value: radius }, strength: { value: 1 },
    };
    this.surface = new Mesh(new PlaneGeometry(2 * radius, 2 * radius, 110, 110), new ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: this.uniforms, transparent: true,
      depthWrite: false, side: DoubleSide,
    }));
    this.surface.renderOrder = 5;
    this.ring = compass(0.8 * reach);
    this.ringRadius = 0.8 * reach;
    this.add(this.surface, this.ring);
  }

  /** Take the waves of a state's water; still without. */
  follow(water) {
    const hs = water?.hs_m ?? 0;
    const period = water?.tp_s ?? 5 * Math.sqrt(Math.max(hs, 0.04));
    const from = towards(water?.wave_from_deg ?? 0);
    this.uniforms.height.value = water?.wave_from_deg === null ? 0 : hs;
    this.uniforms.along.value.set(-from[0], -from[1]);
    this.frequency = (2 * Math.PI) / Math.max(period, 2);
    this.uniforms.number.value = this.frequency ** 2 / GRAVITY; // deep water
  }

  /** Whether there are waves to move. */
  get rolls() {
    return this.uniforms.height.value > 0.05;
  }

  /** Let the waves run on. */
  roll(seconds) {
    const { phase } = this.uniforms;
    phase.value = (phase.value + seconds * this.frequency) % (200 * Math.PI);
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
