// The netting in three dimensions: panels, twines, the still-water ghost and the ±2σ shell.

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Group, LineBasicMaterial,
  LineSegments, Mesh, ShaderMaterial, SRGBColorSpace,
} from "three";

import { Envelope } from "./envelope.js";
import { nodeNormals, triangles } from "./geometry.js";

// Panels are clearest where they are seen edge on, as cloth is; the meshes drawn on them stand for
// the netting and fade where they would be finer than the screen.
const VERTEX = `
attribute vec3 tint;
attribute vec3 place;
varying vec3 vTint, vNormal, vToEye;
varying vec3 vPlace;
void main() {
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  vTint = tint;
  vPlace = place;
  vNormal = normalMatrix * normal;
  vToEye = -eye.xyz;
  gl_Position = projectionMatrix * eye;
}`;
const FRAGMENT = `
uniform float opacity, meshes;
uniform vec3 meshRows;
varying vec3 vTint, vNormal, vToEye;
varying vec3 vPlace;
float lines(float at, float width) {
  float off = abs(fract(at) - 0.5) * 2.0;
  return smoothstep(1.0 - 2.4 * width, 1.0 - 0.6 * width, off);
}
void main() {
  vec3 n = normalize(vNormal);
  vec3 v = normalize(vToEye);
  float facing = abs(dot(n, v));
  float rim = pow(1.0 - facing, 2.2);
  float light = 0.62 + 0.38 * abs(dot(n, normalize(vec3(-0.35, 0.8, 0.45))));
  float turn = atan(vPlace.y, vPlace.x) * meshRows.x;
  float down = vPlace.z * meshRows.y;
  float pixel = max(fwidth(down), max(fwidth(vPlace.x), fwidth(vPlace.y)) * meshRows.x);
  float seen = meshes * (1.0 - smoothstep(0.12, 0.4, pixel));
  float mesh = seen * max(lines(turn, pixel), lines(down, pixel));
  float alpha = opacity * (0.34 + 0.9 * rim) + 0.20 * mesh;
  gl_FragColor = vec4(vTint * light, alpha);
  #include <colorspace_fragment>
}`;
const MESHES_PER_PANEL = 5;

/** The netting of one topology. */
export class Net extends Group {
  constructor(topology) {
    super();
    const { rest, edges, spokes, rings } = topology;
    this.index = triangles(topology);
    this.position3 = attribute(Float32Array.from(rest));
    this.normal3 = attribute(new Float32Array(rest.length));
    this.tint = attribute(new Float32Array(rest.length).fill(1));
    const place = new BufferAttribute(places(topology), 3);
    const around = (spokes * MESHES_PER_PANEL) / (2 * Math.PI);
    const meshRows = { value: { x: around, y: MESHES_PER_PANEL, z: 0 } };

    this.panels = new Mesh(new BufferGeometry(), panelMaterial(0.42, 1, meshRows));
    const { geometry } = this.panels;
    geometry.setIndex(new BufferAttribute(this.index, 1));
    geometry.setAttribute("position", this.position3);
    geometry.setAttribute("normal", this.normal3);
    geometry.setAttribute("tint", this.tint);
    geometry.setAttribute("place", place);

    // The twines share the panels' positions: one update moves both.
    this.twines = new LineSegments(new BufferGeometry(),
      new LineBasicMaterial({ transparent: true, opacity: 0.4, depthWrite: false }));
    this.twines.geometry.setAttribute("position", this.position3);
    this.twines.geometry.setIndex(edges.flat());

    this.ghost = new LineSegments(new BufferGeometry(),
      new LineBasicMaterial({ transparent: true, opacity: 0.22, depthWrite: false }));
    this.ghost.geometry.setAttribute("position", new BufferAttribute(Float32Array.from(rest), 3));
    const few = Uint16Array.from(edges.filter(([a, b]) => keep(a, b, spokes, rings)).flat());
    this.ghost.geometry.setIndex(new BufferAttribute(few, 1));

    this.shell = new Envelope({ rest, index: this.index, normal: this.normal3,
      edges: new BufferAttribute(few, 1) });
    this.panels.renderOrder = 2;
    this.twines.renderOrder = 2;
    this.ghost.renderOrder = 1;
    this.add(this.ghost, this.panels, this.twines, this.shell);
    this.follow(rest, null);
  }

  /** Put every node in its place; sigma (null without) widens the shell. */
  follow(position, sigma) {
    this.position3.array.set(position);
    this.position3.needsUpdate = true;
    nodeNormals(this.position3.array, this.index, this.normal3.array);
    this.normal3.needsUpdate = true;
    this.shell.follow(position, sigma);
    this.panels.geometry.computeBoundingSphere();
    this.twines.geometry.boundingSphere = this.panels.geometry.boundingSphere;
  }

  /** Colour the nodes; `colours` gives [r, g, b] of 0..255, one for each or one for all. */
  paint(colours) {
    const linear = new Color();
    for (let k = 0; k < this.tint.count; k += 1) {
      const [r, g, b] = colours[colours.length > 1 ? k : 0];
      linear.setRGB(r / 255, g / 255, b / 255, SRGBColorSpace).toArray(this.tint.array, 3 * k);
    }
    this.tint.needsUpdate = true;
  }

  /** Take the theme's colours. */
  dress({ twine, ghost, shell, dark }) {
    this.twines.material.color.set(twine);
    this.twines.material.opacity = dark ? 0.4 : 0.5;
    this.ghost.material.color.set(ghost);
    this.shell.dress(shell, dark);
  }
}

const attribute = (array) => new BufferAttribute(array, 3).setUsage(DynamicDrawUsage);

const panelMaterial = (opacity, meshes, meshRows) => new ShaderMaterial({
  vertexShader: VERTEX, fragmentShader: FRAGMENT, side: DoubleSide, transparent: true,
  depthWrite: false, uniforms: { opacity: { value: opacity }, meshes: { value: meshes }, meshRows },
});

/** Where on the cloth each node is: cosine and sine of its meridian, and its row. */
function places({ rest, rings, spokes }) {
  return Float32Array.from(rest, (_, k) => {
    const node = Math.floor(k / 3);
    if (k % 3 === 2) return node === rings * spokes ? rings : Math.floor(node / spokes);
    if (node === rings * spokes) return 0;
    const turn = (2 * Math.PI * (node % spokes)) / spokes;
    return k % 3 ? Math.sin(turn) : Math.cos(turn);
  });
}

/** A ghost of every ring and of every fourth meridian is enough. */
function keep(a, b, spokes, rings) {
  const meridian = b - a === spokes || b === rings * spokes;
  return !meridian || (a % spokes) % Math.max(1, Math.round(spokes / 8)) === 0;
}
