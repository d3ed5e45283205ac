// The rose: every line of a kind where it lies around the cage, as long as its load. Enter or a touch
// chooses one, arrow keys go round.

import { draw } from "../dom.js";
import { text } from "../texts/index.js";
import { compass, known, percent, titled, withUnit } from "./format.js";
import { INNER, OUTER, across, apart, polar, radius, wedge, whisker } from "./rose-shape.js";
import { ringsOf } from "./scale.js";

const WINDS = [0, 90, 180, 270];

export class Rose {
  /** `pick` is called with the name of the line that was chosen. */
  constructor({ pick }) {
    this.pick = pick;
    this.rings = draw("g", { class: "rings" });
    this.bars = draw("g", { class: "bars" });
    this.current = draw("path", { class: "rose-current", d: "M0 -17 8 12 0 6 -8 12Z" });
    this.wave = draw("path", { class: "rose-wave", d: "M0 -110 4.5 -119 -4.5 -119Z" });
    this.drawing = draw("svg", { viewBox: "-122 -121 244 242", class: "rose", role: "group" },
      this.rings, draw("g", { class: "winds" }, ...WINDS.map(wind)), this.bars, this.current,
      this.wave);
    this.drawing.addEventListener("keydown", (event) => this.key(event));
  }

  /** Show other lines: [{name, direction}], in compass degrees. */
  lines(lines) {
    this.directions = lines.map(({ direction }) => direction);
    this.parts = lines.map(({ name }, k) => this.bar(name, k));
    this.bars.replaceChildren(...this.parts.map(({ group }) => group));
    this.end = null;
    this.select(null);
  }

  /** Enter and space choose; arrows go to the next line round the rose, clockwise. */
  key(event) {
    const at = this.parts.findIndex(({ group }) => group === event.target);
    if (at < 0) return;
    const round = this.directions.map((_, k) => k).sort((a, b) => this.directions[a] - this.directions[b]);
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (step) {
      const next = round[(round.indexOf(at) + step + round.length) % round.length];
      this.parts.forEach(({ group }, k) => group.setAttribute("tabindex", k === next ? 0 : -1));
      this.parts[next].group.focus();
    } else if (event.key === "Enter" || event.key === " ") this.pick(this.parts[at].name);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  bar(name, k) {
    const direction = this.directions[k];
    const part = (shape) => draw("path", { class: shape });
    const [space, maximum, fill, low, interval] = ["space", "maximum", "fill", "low", "interval"].map(part);
    const extreme = part("extreme");
    space.setAttribute("d", wedge(direction, OUTER));
    const measured = draw("circle", { class: "measured", r: 3 });
    // Where a wind's letter stands the number stands within.
    const [x, y] = polar(direction, WINDS.some((wind) => apart(direction, wind) < 8) ? OUTER - 7 : OUTER + 11);
    const label = draw("text", { x, y, class: "which" }, name.replace(/^\D+/, "") || name);
    const title = draw("title");
    const group = draw("g", { class: "bar", role: "button", "aria-pressed": false },
      title, space, maximum, fill, low, interval, extreme, measured, label);
    group.dataset.line = name;
    group.addEventListener("click", () => this.pick(name));
    return { name, group, title, maximum, fill, low, interval, extreme, measured };
  }

  /** `loads` are rows as of load-rows.js, `unit` of what their lengths are hundredths. */
  show({ loads, end, unit, current, wave, words }) {
    this.ring(end, unit);
    loads.forEach((load, k) => this.fill(this.parts[k], load, k, end));
    place(this.current, current);
    place(this.wave, wave);
    this.drawing.setAttribute("aria-label", words);
  }

  fill({ group, title, maximum, fill, low, interval, extreme, measured }, load, k, end) {
    const at = this.directions[k];
    const there = known(load.mean);
    outline(fill, there && wedge(at, radius(load.mean, end)));
    fill.style.fill = there ? load.colour : "";
    outline(maximum, known(load.maximum) && wedge(at, radius(load.maximum, end)));
    maximum.style.stroke = load.colour ?? "";
    outline(interval, there && known(load.lower) &&
      whisker(at, radius(load.lower, end), radius(load.upper, end)));
    outline(extreme, known(load.maximumLower) &&
      whisker(at, radius(load.maximumLower, end), radius(load.maximumUpper, end)));
    outline(low, known(load.low) && load.level > 1 && across(at, radius(load.low, end)));
    const [x, y] = known(load.measured) ? polar(at, radius(load.measured, end)) : [0, 0];
    measured.toggleAttribute("hidden", !known(load.measured));
    measured.setAttribute("cx", x);
    measured.setAttribute("cy", y);
    group.dataset.rank = load.rank ?? "";
    title.textContent = barWords(load);
  }

  ring(end, unit) {
    if (this.end === end && this.unit === unit) return;
    Object.assign(this, { end, unit });
    const labelled = this.directions.some((direction) => apart(direction, 0) < 8) ? 45 : 0; // clear of a bar
    const circles = ringsOf(end).flatMap((share) => {
      const r = radius(share, end);
      const capacity = share === 1 && unit === "%" ? " capacity" : "";
      return [draw("circle", { r, class: `ring${capacity}` }),
        ringLabel(polar(labelled, r), `${Math.round(100 * share)} ${unit}`)];
    });
    this.rings.replaceChildren(draw("circle", { r: INNER, class: "ring" }), ...circles);
  }

  select(chosen) {
    const stop = this.parts?.some(({ name }) => name === chosen) ? chosen : this.parts?.[0].name;
    this.parts?.forEach(({ name, group }) => {
      group.toggleAttribute("data-chosen", name === chosen);
      group.setAttribute("aria-pressed", name === chosen);
      group.setAttribute("tabindex", name === stop ? 0 : -1);
    });
  }
}

/** A line's load in words; what is not known is not said. */
function barWords({ name, kn, mean, share, maximumKn }) {
  const about = { name: titled(name), load: withUnit(kn, "kN"), share: percent(mean) };
  const words = share === false ? text("loads.barAlone", about) : text("loads.bar", about);
  return known(maximumKn) ? text("loads.barMaximum", { words, maximum: withUnit(maximumKn, "kN") }) : words;
}

const ringLabel = ([x, y], words) => draw("text", { x, y, class: "ring-label" }, words);

function wind(degrees) {
  const [x, y] = polar(degrees, OUTER + 13);
  return draw("text", { x, y, class: "wind" }, compass(degrees));
}

function outline(path, d) {
  path.toggleAttribute("hidden", !d);
  if (d) path.setAttribute("d", d);
}

function place(shape, degrees) {
  shape.toggleAttribute("hidden", !known(degrees));
  if (known(degrees)) shape.setAttribute("transform", `rotate(${degrees})`);
}
