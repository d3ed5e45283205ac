// A frame as the service writes it, for the stand-in service and for tests.

const aligned = (at) => Math.ceil(at / 8) * 8;

/**
 * Encode; displacement x y z of each node in turn and sigma [m] are null without valid input,
 * sigma alone where no spread is known.
 */
export function encodeFrame({ t, flags, state, displacement, sigma }) {
  const words = new TextEncoder().encode(JSON.stringify(state));
  const nodes = (displacement?.length ?? 0) / 3;
  const noSpread = nodes && !sigma ? 16 : 0;
  const spreadAt = aligned(32 + 6 * nodes);
  const wordsAt = aligned(spreadAt + (sigma?.length ?? 0));
  const buffer = new ArrayBuffer(wordsAt + words.length);
  const view = new DataView(buffer);
  const moved = unit(displacement ?? [], 32767);
  const spread = unit(sigma ?? [], 255);
  [..."SCFR"].forEach((letter, k) => view.setUint8(k, letter.charCodeAt(0)));
  view.setUint16(4, 2, true);
  view.setUint16(6, flags | noSpread, true);
  view.setFloat64(8, t, true);
  view.setUint32(16, nodes, true);
  view.setUint32(20, words.length, true);
  view.setFloat32(24, moved, true);
  view.setFloat32(28, spread, true);
  displacement?.forEach((metres, k) =>
    view.setInt16(32 + 2 * k, Math.round(metres / moved), true));
  sigma?.forEach((metres, k) => view.setUint8(spreadAt + k, Math.round(metres / spread)));
  new Uint8Array(buffer, wordsAt).set(words);
  return buffer;
}

const unit = (metres, most) =>
  metres.reduce((largest, one) => Math.max(largest, Math.abs(one)), 1e-6 * most) / most;
