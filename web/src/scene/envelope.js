// Where the net may be: an inner and an outer surface, two standard deviations from the net.

import {
  AdditiveBlending, BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Group,
  LineBasicMaterial, LineSegments, Mesh, NormalBlending, ShaderMaterial,
} from "three";

const SIGMAS = 2;
// The outline alone is drawn: a surface that is seen face on would hide the net between the two.
const VERTEX = `
varying vec3 vNormal, vToEye;
void main() {
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  vToEye = -eye.xyz;
  gl_Position = projectionMatrix * eye;
}`;
const FRAGMENT = `
uniform vec3 colour;
varying vec3 vNormal, vToEye;
void main() {
  float rim = pow(1.0 - abs(dot(normalize(vNormal), normalize(vToEye))), 6.0);
  gl_FragColor = vec4(colour, 0.02 + 0.5 * rim);
  #include <colorspace_fragment>
}`;

/** The two surfaces of one net: its `index` of triangles, normals, and the edges that are drawn. */
export class Envelope extends Group {
  constructor({ rest, index, normal, edges }) {
    super();
    this.normal = normal;
    this.colour = { value: new Color() };
    this.lines = new LineBasicMaterial({ transparent: true, opacity: 0.65, depthWrite: false });
    this.sides = [1, -1].map((side) => {
      const position = new BufferAttribute(Float32Array.from(rest), 3).setUsage(DynamicDrawUsage);
      const surface = new Mesh(new BufferGeometry(), new ShaderMaterial({
        vertexShader: VERTEX, fragmentShader: FRAGMENT, side: DoubleSide, transparent: true,
        depthWrite: false, uniforms: { colour: this.colour },
      }));
      surface.geometry.setIndex(new BufferAttribute(index, 1));
      surface.geometry.setAttribute("normal", normal);
      const frame = new LineSegments(new BufferGeometry(), this.lines);
      frame.geometry.setIndex(edges);
      for (const one of [surface, frame]) {
        one.geometry.setAttribute("position", position);
        one.renderOrder = 3;
      }
      this.add(surface);
      if (side > 0) this.add(frame); // lines of both would be taken for the net
      return { side, position, surface, frame };
    });
  }

  /** Keep its distance from a net; sigma [m] is null where no spread is known. */
  follow(net, sigma) {
    for (const { side, position, surface, frame } of this.sides) {
      position.array.forEach((_, k) => {
        const out = side * SIGMAS * (sigma ? sigma[Math.floor(k / 3)] : 0);
        position.array[k] = net[k] + out * this.normal.array[k];
      });
      position.needsUpdate = true;
      surface.geometry.computeBoundingSphere();
      frame.geometry.boundingSphere = surface.geometry.boundingSphere;
    }
  }

  /** Take the theme's colour. */
  dress(colour, dark) {
    this.colour.value.set(colour);
    this.lines.color.set(colour);
    for (const { surface } of this.sides) {
      surface.material.blending = dark ? AdditiveBlending : NormalBlending;
    }
  }
}
