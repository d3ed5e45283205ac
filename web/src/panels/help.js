// What the page shows and which keys it knows.

import { make } from "../dom.js";
import { icon } from "./icons.js";

const KEYS = [
  ["1 2 3 4", "loads, charts, alarms, what if"], ["L", "back to live"],
  ["Space", "play or pause the past"], [", and .", "a step back or on in time"],
  ["F", "the farm: all cages"], ["T", "light or dark"], ["V", "two or three dimensions"], ["Esc", "close, or let go of what is chosen"],
  ["?", "this page"],
];
const WORDS = [
  ["Twin", "what the digital twin predicts, with its 95 % interval where one is known."],
  ["Largest load", "the largest that is known, predicted or measured, and who says so; the alarms take the same."],
  ["Level", "2 where a sensor on the cage has trained the twin, and its interval is for what the sensor reads. " +
    "1 where it is simulation alone, whose error at sea is not known: it has no interval."],
  ["±2σ", "the envelope that the net is in with a chance of 95 %, where that is known."],
  ["Extrapolating", "the sea is beyond what the twin has learned; its intervals are wider, and it may err more."],
  ["No valid input", "nothing usable has been measured of the sea, so nothing is computed: a dash is no zero."],
  ["Directions", "currents go towards, waves come from; degrees clockwise from true north. Times are UTC."],
];

export class Help {
  constructor() {
    const close = make("button", { type: "button", className: "round", ariaLabel: "Close",
      onclick: () => this.dialog.close() }, icon("close"));
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "help-title" },
      make("header", { className: "sheet-head" }, make("h2", { id: "help-title" }, "Help and keys"), close),
      make("h3", {}, "Keys"),
      make("dl", { className: "keys" }, ...KEYS.flatMap(([keys, words]) =>
        [make("dt", {}, make("kbd", {}, keys)), make("dd", {}, words)])),
      make("h3", {}, "Words"),
      make("dl", { className: "words" }, ...WORDS.flatMap(([word, words]) =>
        [make("dt", {}, word), make("dd", {}, words)])),
      make("p", { className: "aside" },
        "The page watches; it moves nothing at the cage. It supports inspection and is no proof of compliance."));
    document.body.append(this.dialog);
  }

  open() {
    if (!this.dialog.open) this.dialog.showModal();
  }
}
