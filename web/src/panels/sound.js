// A short tone for a new alarm, off until somebody wants it.

import { make } from "../dom.js";
import { text } from "../texts/index.js";

const KEY = "seacage-sound";
const TONES = { critical: [660, 880, 660, 880], warning: [660, 880], note: [660] };
let context;

const wanted = () => localStorage.getItem(KEY) === "on";

/** Sound the rank of an alarm, if sound is wanted. */
export function sound(rank) {
  if (!wanted()) return;
  // A browser lets a page sound only after a click; the switch was one.
  context ??= new AudioContext();
  TONES[rank].forEach((pitch, k) => tone(pitch, context.currentTime + 0.22 * k));
}

function tone(pitch, at) {
  const [source, volume] = [context.createOscillator(), context.createGain()];
  source.frequency.value = pitch;
  volume.gain.setValueAtTime(0, at);
  volume.gain.linearRampToValueAtTime(0.12, at + 0.02);
  volume.gain.linearRampToValueAtTime(0, at + 0.18);
  source.connect(volume).connect(context.destination);
  source.start(at);
  source.stop(at + 0.2);
}

/** A box to tick; it sounds once when it is ticked. */
export function soundSwitch() {
  const box = make("input", { type: "checkbox", checked: wanted() });
  box.addEventListener("change", () => {
    localStorage.setItem(KEY, box.checked ? "on" : "off");
    sound("note");
  });
  return make("label", {}, box, ` ${text("alarms.sound")}`);
}
