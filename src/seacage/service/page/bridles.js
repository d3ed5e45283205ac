// The loads of the bridles: one row each, grouped by the corner they come from.

import { explain, make } from "./dom.js";
import { fixed, half, percent, ticks } from "./format.js";
import { loadColour } from "./net.js";

const CORNERS = ["north-east", "north-west", "south-west", "south-east"];
const SCALES = [20, 30, 50, 80, 120, 200, 300, 500, 1000];

export class Bridles {
  constructor({ table, capacity, legend }) {
    this.body = table.tBodies[0];
    this.capacity = capacity;
    explain(legend, {
      bar: "twin", band: "95 % interval", tick: "simulation alone", dot: "measured",
      taught: "taught by a shackle",
    });
  }

  topology({ bridle_names: names, bridle_corners: corners, bridle_capacity_kn: limits, shackles }) {
    this.shackles = new Map(shackles.map(({ name, bridle }) => [bridle, name]));
    const [low, high] = [Math.min(...limits), Math.max(...limits)];
    this.capacity.textContent =
      `capacity ${low === high ? "" : `${fixed(low, 0)} to `}${fixed(high, 0)} kN each`;
    this.rows = names.map((name, k) => this.row(name, k, corners));
    this.body.replaceChildren(...this.rows.map(({ row }) => row), this.axis());
  }

  row(name, k, corners) {
    const parts = Object.fromEntries(
      ["bar", "band", "tick", "dot"].map((part) => [part, make("span", { className: part })]));
    const [tension, share] = [make("td", { className: "number" }), make("td", { className: "share" })];
    const number = make("span", { className: "which" }, String(k + 1));
    const taught = this.shackles.has(k);
    const label = make("th", { scope: "row", title: `${name}, ${CORNERS[corners[k]] ?? ""} corner` },
      number, make("span", { className: "unseen" }, ` ${CORNERS[corners[k]] ?? ""} corner`));
    if (taught) label.append(make("span", { className: "key taught", title: this.shackles.get(k) }));
    const track = make("div", { className: "track" }, ...Object.values(parts));
    const row = make("tr", {}, label, make("td", { className: "load" }, track), tension, share);
    if (k && corners[k] !== corners[k - 1]) row.className = "next-corner";
    return { row, parts, tension, share };
  }

  axis() {
    this.scale = make("div", { className: "track axis", ariaHidden: "true" });
    return make("tr", { className: "axis-row", ariaHidden: "true" },
      make("td"), make("td", { className: "load" }, this.scale), make("td"), make("td"));
  }

  show({ bridles, sensors }) {
    const read = new Map(sensors.map((sensor) => [sensor.name, sensor.measured]));
    const measured = bridles.map((_, k) => read.get(this.shackles.get(k)) ?? null);
    const top = Math.max(...bridles.map((one) => one.tension_kn.upper ?? 0), ...measured);
    this.limit = SCALES.find((limit) => limit >= top) ?? 1.1 * top;
    bridles.forEach((one, k) => this.fill(this.rows[k], one, measured[k]));
    const { marks } = ticks(0, this.limit, 4);
    this.scale.replaceChildren(...marks.map((mark) => {
      const label = make("span", {}, mark === marks.at(-1) ? `${mark} kN` : String(mark));
      label.style.left = this.at(mark);
      return label;
    }));
  }

  fill({ row, parts, tension, share }, bridle, measured) {
    const { mean, lower, upper } = bridle.tension_kn;
    place(parts.bar, mean !== null, "0%", this.at(mean));
    place(parts.band, lower !== null, this.at(lower), this.at(upper - lower));
    place(parts.tick, bridle.level > 1 && mean !== null, this.at(bridle.low_fidelity_kn));
    place(parts.dot, measured !== null, this.at(measured));
    parts.bar.style.backgroundColor = loadColour(bridle.utilisation);
    row.classList.toggle("near", bridle.utilisation >= 0.8);
    row.classList.toggle("over", bridle.utilisation >= 1);
    tension.replaceChildren(
      make("b", {}, fixed(mean)), make("span", { className: "pm" }, half(bridle.tension_kn)));
    share.textContent = percent(bridle.utilisation);
  }

  at(kn) {
    return `${Math.min(100, Math.max(0, (100 * kn) / this.limit))}%`;
  }
}

function place(part, there, left, width) {
  part.hidden = !there;
  if (!there) return;
  part.style.left = left;
  if (width) part.style.width = width;
}
