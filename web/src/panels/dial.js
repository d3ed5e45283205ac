// A compass to turn by hand or by keys.

import { draw, make } from "../dom.js";
import { bearing, compass, spoken, turned } from "./format.js";

const STEPS = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 15, PageDown: -15 };
const MARKS = Array.from({ length: 16 }, (_, k) => 22.5 * k);

/**
 * Make a dial.
 *
 * @param {{name: string, says: (degrees: number) => string, kind: string,
 *   turn: (degrees: number) => void}} wanted `kind` is "to" (the needle points there) or "from"
 *   (it comes from there)
 */
export function dial({ name, kind, says, turn }) {
  const needle = draw("path", { class: `dial-needle ${kind}`, d: kind === "to" ? TO : FROM });
  const circle = draw("circle", { r: 44, class: "dial-face" });
  const face = draw("svg", { viewBox: "-50 -60 100 110", "aria-hidden": "true" }, circle,
    ...MARKS.map((degrees) => draw("path", {
      class: "dial-mark", d: degrees % 90 ? "M0-44v3" : "M0-44v6", transform: `rotate(${degrees})`,
    })),
    draw("text", { class: "dial-north", y: -53 }, compass(0)), needle);
  const words = make("output", { className: "dial-words" });
  const slider = make("div", {
    className: "dial", role: "slider", tabIndex: 0, ariaLabel: name, ariaValueMin: "0", ariaValueMax: "359",
  }, face);
  let value = 0;

  function show(degrees) {
    value = turned(Math.round(degrees)) % 360;
    slider.ariaValueNow = String(value);
    slider.ariaValueText = `${bearing(value)}, ${spoken(value)}`;
    needle.setAttribute("transform", `rotate(${value})`);
    words.textContent = says(value);
  }

  function choose(degrees) {
    show(degrees);
    turn(value);
  }

  let centre; // as it was when the hand came: what is answered may move the page under it
  const pointed = ({ clientX, clientY }) =>
    choose((Math.atan2(clientX - centre.x, centre.y - clientY) * 180) / Math.PI);
  slider.addEventListener("pointerdown", (event) => {
    const box = circle.getBoundingClientRect();
    centre = { x: box.left + box.width / 2, y: box.top + box.height / 2 };
    slider.setPointerCapture(event.pointerId);
    pointed(event);
  });
  slider.addEventListener("pointermove", (event) => {
    if (slider.hasPointerCapture(event.pointerId)) pointed(event);
  });
  slider.addEventListener("keydown", (event) => {
    const step = STEPS[event.key];
    if (step === undefined && event.key !== "Home") return;
    event.preventDefault();
    choose(event.key === "Home" ? 0 : value + step * (event.shiftKey ? 10 : 1));
  });
  const title = make("span", { className: "dial-name" }, name);
  return { box: make("div", { className: "dial-box" }, title, slider, words), show };
}

const TO = "M0-34 9 4 0-1-9 4ZM-1.5 2h3v28h-3Z";
const FROM = "M0-14-9-36h18ZM-1.5-12h3v12h-3Z";
