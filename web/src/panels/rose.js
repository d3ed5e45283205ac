// The rose: every bridle where it leaves the collar, as long as its load.

import { draw } from "../dom.js";
import { text } from "../texts/index.js";
import { compass, known, percent, titled, withUnit } from "./format.js";
import { INNER, OUTER, across, azimuths, polar, radius, wedge, whisker } from "./rose-shape.js";
import { ringsOf } from "./scale.js";

export class Rose {
  /** `pick` is called with the name of the bridle that was chosen. */
  constructor({ pick }) {
    this.pick = pick;
    this.rings = draw("g", { class: "rings" });
    this.bars = draw("g", { class: "bars" });
    this.current = draw("path", { class: "rose-current", d: "M0 -17 8 12 0 6 -8 12Z" });
    this.wave = draw("path", { class: "rose-wave", d: "M0 -110 4.5 -119 -4.5 -119Z" });
    this.drawing = draw("svg", { viewBox: "-122 -121 244 242", class: "rose", role: "img" },
      this.rings, draw("g", { class: "winds" }, ...[0, 90, 180, 270].map(wind)), this.bars, this.current,
      this.wave);
  }

  topology(topology) {
    this.directions = azimuths(topology);
    this.parts = topology.bridle_names.map((name, k) => this.bar(name, k));
    this.bars.replaceChildren(...this.parts.map(({ group }) => group));
  }

  bar(name, k) {
    const direction = this.directions[k];
    const part = (shape) => draw("path", { class: shape });
    const [space, maximum, fill, low, interval] = ["space", "maximum", "fill", "low", "interval"].map(part);
    space.setAttribute("d", wedge(direction, OUTER));
    const measured = draw("circle", { class: "measured", r: 3 });
    const [x, y] = polar(direction, OUTER + 11);
    const label = draw("text", { x, y, class: "which" }, name.replace(/^\D+/, "") || name);
    const title = draw("title");
    const group = draw("g", { class: "bar" }, title, space, maximum, fill, low, interval, measured, label);
    group.addEventListener("click", () => this.pick(name));
    return { name, group, title, maximum, fill, low, interval, measured };
  }

  /** `loads` are rows as of load-rows.js. */
  show({ loads, end, current, wave, words }) {
    this.ring(end);
    loads.forEach((load, k) => this.fill(this.parts[k], load, k, end));
    place(this.current, current);
    place(this.wave, wave);
    this.drawing.setAttribute("aria-label", words);
  }

  fill({ group, title, maximum, fill, low, interval, measured }, load, k, end) {
    const at = this.directions[k];
    const there = known(load.mean);
    outline(fill, there && wedge(at, radius(load.mean, end)));
    fill.style.fill = there ? load.colour : "";
    outline(maximum, known(load.maximum) && wedge(at, radius(load.maximum, end)));
    maximum.style.stroke = load.colour ?? "";
    outline(interval, there && known(load.lower) &&
      whisker(at, radius(load.lower, end), radius(load.upper, end)));
    outline(low, known(load.low) && load.level > 1 && across(at, radius(load.low, end)));
    const [x, y] = known(load.measured) ? polar(at, radius(load.measured, end)) : [0, 0];
    measured.toggleAttribute("hidden", !known(load.measured));
    measured.setAttribute("cx", x);
    measured.setAttribute("cy", y);
    group.dataset.rank = load.rank ?? "";
    title.textContent = text("loads.bar",
      { name: titled(load.name), load: withUnit(load.kn, "kN"), share: percent(load.mean) });
  }

  ring(end) {
    if (this.end === end) return;
    this.end = end;
    const circles = ringsOf(end).flatMap((share) => {
      const r = radius(share, end);
      const capacity = share === 1 ? " capacity" : "";
      return [draw("circle", { r, class: `ring${capacity}` }),
        draw("text", { x: 0, y: -r, class: "ring-label" }, `${Math.round(100 * share)} %`)];
    });
    this.rings.replaceChildren(draw("circle", { r: INNER, class: "ring" }), ...circles);
  }

  select(chosen) {
    this.parts?.forEach(({ name, group }) => group.toggleAttribute("data-chosen", name === chosen));
  }
}

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
