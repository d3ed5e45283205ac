// What the service sends: one little-endian binary frame per state of a cage.

import { text } from "./texts/index.js";

const MAGIC = 0x52464353; // "SCFR"
const VERSION = 2;
const HEADER = 32;
const aligned = (at) => Math.ceil(at / 8) * 8;

export const VALID = 1;
export const IN_DOMAIN = 2;
export const PAST = 4;
export const NO_SPREAD = 16;

/**
 * Read a frame.
 *
 * @param {ArrayBuffer} buffer
 * @param {Float32Array} rest where the nodes are in still water, x y z of each in turn [m]
 * @returns {{t: number, flags: number, state: object, position: Float32Array|null,
 *   sigma: Float32Array|null}} t in ms since 1970 UTC; positions and sigma in metres, null
 *   without valid input; sigma also where no honest spread is known
 */
export function readFrame(buffer, rest) {
  const view = new DataView(buffer);
  if (buffer.byteLength < HEADER || view.getUint32(0, true) !== MAGIC) {
    throw new Error(text("frame.magic", { bytes: buffer.byteLength }));
  }
  const version = view.getUint16(4, true);
  if (version !== VERSION) {
    throw new Error(text("frame.version", { version, known: VERSION }));
  }
  const nodes = view.getUint32(16, true);
  const spreadAt = aligned(HEADER + 6 * nodes);
  const flags = view.getUint16(6, true);
  const isSpread = (flags & NO_SPREAD) === 0;
  const wordsAt = aligned(spreadAt + (isSpread ? nodes : 0));
  const words = new Uint8Array(buffer, wordsAt, view.getUint32(20, true));
  const valid = (flags & VALID) !== 0;
  if (valid && 3 * nodes !== rest.length) {
    throw new Error(text("frame.nodes", { nodes, rest: rest.length / 3 }));
  }
  return {
    t: view.getFloat64(8, true),
    flags,
    state: JSON.parse(new TextDecoder().decode(words)),
    position: valid ? moved(view, rest) : null,
    sigma: valid && isSpread
      ? spread(new Uint8Array(buffer, spreadAt, nodes), view.getFloat32(28, true)) : null,
  };
}

function moved(view, rest) {
  const unit = view.getFloat32(24, true);
  return rest.map((metres, k) => metres + unit * view.getInt16(HEADER + 2 * k, true));
}

function spread(units, unit) {
  return Float32Array.from(units, (count) => unit * count);
}
