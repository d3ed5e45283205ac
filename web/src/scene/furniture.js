// What lies over the drawing: names, compass and scale bar.

import { draw, make } from "../dom.js";
import { compass as compassPoint, localDigits } from "../panels/format.js";
import { text } from "../texts/index.js";
import { shown, unitName } from "../units.js";

const BAR_PX = [60, 150];

/** Names pinned to points of the scene. */
export class Labels {
  constructor(holder) {
    this.layer = make("div", { className: "scene-labels", "aria-hidden": "true" });
    this.all = new Map();
    holder.append(this.layer);
  }

  /** Pin words at a place on the screen [px], or hide them where `at` is null. */
  pin(name, words, at) {
    let label = this.all.get(name);
    if (!label) {
      label = make("span", { className: `scene-label ${name}` });
      this.all.set(name, label);
      this.layer.append(label);
    }
    label.hidden = !at || !words;
    if (label.hidden) return;
    if (label.textContent !== words) {
      label.textContent = words;
      label.half = label.offsetWidth / 2 + 6;
    }
    // A name that is seen is seen whole.
    const width = this.layer.clientWidth;
    const inside = at[0] > -label.half && at[0] < width + label.half;
    const x = inside ? Math.min(Math.max(at[0], label.half), width - label.half) : at[0];
    label.style.transform =
      `translate(${Math.round(x)}px, ${Math.round(at[1])}px) translate(-50%, -50%)`;
  }
}

/** A compass whose needle keeps to the north. */
export function compass(onClick) {
  const needle = draw("g", {},
    draw("path", { d: "M0 -15 L5 0 L0 -3.500 L-5 0 Z", class: "needle-north" }),
    draw("path", { d: "M0 15 L5 0 L0 3.500 L-5 0 Z", class: "needle-south" }),
    draw("text", { y: -18, class: "needle-name" }, compassPoint(0)));
  const button = make("button", {
    type: "button", className: "scene-compass", title: text("scene.north"), "aria-label": text("scene.north"),
  }, draw("svg", { viewBox: "-30 -30 60 60", "aria-hidden": "true" },
    draw("circle", { r: 27, class: "compass-face" }), needle));
  button.addEventListener("click", onClick);
  return { element: button, turn: (degrees) => needle.setAttribute("transform", `rotate(${degrees})`) };
}

/** A bar of a round length. */
export function scaleBar() {
  const words = make("span");
  const bar = make("span", { className: "scale-line" });
  const element = make("div", { className: "scene-scale" }, bar, words);
  return {
    element,
    show(pxPerMetre) {
      const perUnit = pxPerMetre / shown(1, "m");
      const length = roundLength(perUnit);
      element.hidden = !Number.isFinite(length);
      bar.style.width = `${Math.round(length * perUnit)}px`;
      words.textContent = `${localDigits(String(length))} ${unitName("m")}`;
    },
  };
}

/** The longest round length that fits the bar, in the unit that has so many pixels. */
export function roundLength(pxPerUnit) {
  const most = BAR_PX[1] / pxPerUnit;
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((one) => one * power).find((one) => one <= most);
}
