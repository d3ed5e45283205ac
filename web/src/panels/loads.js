// The loads: the rose and, beside it, the same in numbers.

import { make } from "../dom.js";
import { bridleColours } from "../scene/paint.js";
import { noSpread } from "../scene/words.js";
import { onTheme } from "../theme.js";
import { explain, write } from "./dom.js";
import { fixed, half, known, percent, plain, spoken, titled, withUnit } from "./format.js";
import { largest, loadRows } from "./load-rows.js";
import { Rose } from "./rose.js";
import { scaleFor } from "./scale.js";

const NO_INTERVAL = "No interval is known here.";
const HEADS = ["Bridle", "Twin", "Simulated", "Measured", "Of capacity"];

export class Loads {
  constructor(holder, model) {
    this.model = model;
    this.rose = new Rose({ pick: (name) => model.select({ bridle: name }) });
    this.body = make("tbody");
    const heads = HEADS.map((head) => make("th", { scope: "col" }, head));
    this.caption = make("p", { className: "aside" });
    this.table = make("table", { className: "loads" },
      make("caption", { className: "unseen" }, "Tension of each bridle with its 95 % interval"),
      make("thead", {}, make("tr", {}, ...heads)), this.body);
    holder.append(
      make("div", { className: "rose-holder" }, this.rose.drawing),
      explain({ bar: "twin", whisker: "95 % interval", tick: "simulation alone", dot: "measured" }),
      make("div", { className: "table-holder" }, this.table), this.caption);
    model.on("topology", () => this.topology());
    model.on("view", () => this.show());
    model.on("selection", () => this.select());
    model.options.on(() => this.show());
    onTheme(() => this.show());
    this.topology();
  }

  topology() {
    const topology = this.model.topology;
    if (!topology) return;
    this.rose.topology(topology);
    this.rows = topology.bridle_names.map((name, k) => this.row(name, k, topology));
    this.body.replaceChildren(...this.rows.map(({ row }) => row));
    const limits = topology.bridle_capacity_kn;
    const [low, high] = [Math.min(...limits), Math.max(...limits)];
    this.capacity = `Capacity ${low === high ? "" : `${fixed(low, 0)} to `}${fixed(high, 0)} kN each; ` +
      "tensions in kN. Level 2 is trained by a shackle, level 1 is simulation alone.";
    this.show();
    this.select();
  }

  row(name, k, { bridle_corners: corners }) {
    const button = make("button", { type: "button", onclick: () => this.model.select({ bridle: name }) },
      titled(name));
    const level = make("span", { className: "level" });
    const cells = ["twin", "low", "measured"].map((c) => make("td", { className: `number ${c}` }));
    const [fill, share] = [make("span", { className: "share-fill" }), make("span", { className: "share" })];
    const bar = make("div", { className: "share-bar" }, fill);
    const row = make("tr", {}, make("th", { scope: "row" }, button, level), ...cells,
      make("td", { className: "of-capacity" }, make("div", { className: "share-line" }, bar, share)));
    if (k && corners[k] !== corners[k - 1]) row.className = "next-corner";
    return { name, row, button, level, cells, fill, share };
  }

  show() {
    const { topology, view } = this.model;
    if (!topology || !view?.state || !this.rows) return;
    const loads = loadRows(topology, view.state, bridleColours(topology, view, this.model.options));
    this.end = scaleFor(largest(loads), this.end);
    const water = view.state.valid ? view.state.water : null;
    this.rose.show({
      loads, end: this.end, current: water?.current_to_deg, wave: water?.wave_from_deg,
      words: roseWords(loads, water),
    });
    loads.forEach((load, k) => fill(this.rows[k], load, this.end));
    const reason = loads.find(({ kn, interval }) => known(kn) && !interval)?.reason;
    const shape = view.position && !view.sigma ? noSpread(view.state) : "";
    write(this.caption, [this.capacity, reason && `No interval at level 1: ${lowered(reason)}`,
      shape && `No ±2σ of the net: ${lowered(shape)}`].filter(Boolean).join(" "));
  }

  select() {
    const chosen = this.model.selection?.bridle ?? null;
    this.rose.select(chosen);
    this.rows?.forEach(({ name, row, button }) => {
      row.toggleAttribute("data-chosen", name === chosen);
      button.setAttribute("aria-pressed", name === chosen);
    });
  }
}

function fill({ row, level, cells, fill: bar, share }, load, end) {
  const [twin, low, measured] = cells;
  write(level, `${load.level}${load.within ? "" : " outside"}`);
  level.classList.toggle("outside", !load.within);
  level.title = (load.level > 1 ? `level ${load.level}: trained by ${load.shackle ?? "a shackle"}`
    : "level 1: simulation alone")
    + (load.within ? "" : ", and outside the training domain of this level");
  twin.replaceChildren(make("b", {}, fixed(load.kn)),
    make("span", { className: "pm" }, half(load.interval)));
  twin.title = known(load.kn) && !load.interval ? load.reason || NO_INTERVAL : "";
  write(low, fixed(load.lowKn));
  write(measured, load.shackle ? fixed(load.measuredKn) : "");
  measured.title = load.shackle && !known(load.measuredKn)
    ? `${plain(load.shackle)} has given no good reading within its timeout` : "";
  write(share, percent(load.top));
  bar.style.width = `${Math.min(100, (100 * (load.top ?? 0)) / Math.max(1, end))}%`;
  bar.style.backgroundColor = known(load.top) ? load.colour : "";
  row.dataset.rank = load.rank ?? "";
}

function roseWords(loads, water) {
  const loaded = loads.filter(({ top }) => known(top));
  if (!loaded.length) return "Rose of bridle loads: no valid input, no loads.";
  const most = loaded.reduce((a, b) => (b.top > a.top ? b : a));
  const flow = Number.isFinite(water?.current_to_deg) ? ` The current goes ${spoken(water.current_to_deg)}.` : "";
  return `Rose of bridle loads, north up. Largest: ${plain(most.name)}, ` +
    `${withUnit(most.topKn, "kN")}, ${percent(most.top)} of capacity.${flow} The table has all.`;
}

const lowered = (sentence) => sentence[0].toLowerCase() + sentence.slice(1);
