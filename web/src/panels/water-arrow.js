// A small arrow that points where something goes, north up.

import { draw } from "../dom.js";

/** Make an arrow; `turn` points it, and hides it where the direction is not known. */
export function waterArrow(kind) {
  const shape = draw("path", { d: kind === "wave" ? WAVE : CURRENT });
  const arrow = draw("svg", { viewBox: "-12 -12 24 24", class: `arrow ${kind}`, "aria-hidden": "true" },
    draw("circle", { r: 11 }), shape);
  const turn = (degrees) => {
    arrow.toggleAttribute("data-unknown", !Number.isFinite(degrees));
    if (Number.isFinite(degrees)) shape.setAttribute("transform", `rotate(${degrees})`);
  };
  return { arrow, turn };
}

const CURRENT = "M0 -8.5 5.2 6.5 0 3.2 -5.2 6.5Z";
const WAVE = "M0 -8 4 -1.5H-4ZM-5 3q2.5-3 5 0t5 0M-5 7q2.5-3 5 0t5 0";
