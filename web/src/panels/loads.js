// The loads: the rose and, beside it, the same in numbers.

import { make } from "../dom.js";
import { bridleColours } from "../scene/paint.js";
import { noSpread } from "../scene/words.js";
import { text } from "../texts/index.js";
import { onTheme } from "../theme.js";
import { explain, tableHead, write } from "./dom.js";
import { fixed, half, known, percent, plain, spoken, titled, withUnit } from "./format.js";
import { LineTable } from "./line-table.js";
import { largest, loadRows } from "./load-rows.js";
import { Rose } from "./rose.js";
import { scaleFor } from "./scale.js";

export class Loads {
  constructor(holder, model) {
    this.model = model;
    this.rose = new Rose({ pick: (name) => model.select({ bridle: name }) });
    this.body = make("tbody");
    this.caption = make("p", { className: "aside" });
    this.lines = new LineTable();
    this.table = make("table", { className: "loads" },
      make("caption", { className: "unseen" }, text("loads.caption")),
      tableHead(["bridle", "twin", "simulated", "measured", "share"].map((head) => text(`loads.heads.${head}`))),
      this.body);
    this.legend = explain(
      { bar: "twin", whisker: "interval", ghost: "maximum", tick: "simulated", dot: "measured" });
    holder.append(
      make("div", { className: "rose-holder" }, this.rose.drawing), this.legend,
      make("div", { className: "table-holder" }, this.table), this.caption, this.lines.drawing);
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
    const [lower, upper] = [Math.min(...limits), Math.max(...limits)].map((kn) => fixed(kn, 0));
    this.capacity = text("loads.capacity",
      { capacity: lower === upper ? upper : text("number.range", { lower, upper }) });
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
    this.lines.show(view.state);
    this.legend.querySelector(".ghost").parentElement.hidden = !view.state.lines?.length;
    const water = view.state.valid ? view.state.water : null;
    this.rose.show({
      loads, end: this.end, current: water?.current_to_deg, wave: water?.wave_from_deg,
      words: roseWords(loads, water),
    });
    loads.forEach((load, k) => fill(this.rows[k], load, this.end));
    const reason = loads.find(({ kn, interval }) => known(kn) && !interval)?.reason;
    const shape = view.position && !view.sigma ? noSpread(view.state) : "";
    write(this.caption, [this.capacity, reason && text("loads.noIntervalWhy", { reason: lowered(reason) }),
      shape && text("loads.noSpreadWhy", { reason: lowered(shape) })].filter(Boolean).join(" "));
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
  const trained = load.level > 1
    ? text("loads.trained", { level: load.level, shackle: load.shackle ?? text("loads.shackle") })
    : text("loads.simulation");
  write(level, load.within ? String(load.level) : text("loads.outside", { level: load.level }));
  level.classList.toggle("outside", !load.within);
  level.title = load.within ? trained : text("loads.outsideDomain", { level: trained });
  twin.replaceChildren(make("b", {}, fixed(load.kn)),
    make("span", { className: "pm" }, half(load.interval)));
  twin.title = known(load.kn) && !load.interval ? load.reason || text("loads.noInterval") : "";
  write(low, fixed(load.lowKn));
  write(measured, load.shackle ? fixed(load.measuredKn) : "");
  measured.title = load.shackle && !known(load.measuredKn)
    ? text("loads.noReading", { shackle: plain(load.shackle) }) : "";
  write(share, percent(load.top));
  bar.style.width = `${Math.min(100, (100 * (load.top ?? 0)) / Math.max(1, end))}%`;
  bar.style.backgroundColor = known(load.top) ? load.colour : "";
  row.dataset.rank = load.rank ?? "";
}

function roseWords(loads, water) {
  const loaded = loads.filter(({ top }) => known(top));
  if (!loaded.length) return text("loads.noRose");
  const most = loaded.reduce((a, b) => (b.top > a.top ? b : a));
  return text("loads.rose", {
    name: plain(most.name), load: withUnit(most.topKn, "kN"), share: percent(most.top),
    flow: known(water?.current_to_deg) ? text("loads.flow", { direction: spoken(water.current_to_deg) }) : "",
  });
}

const lowered = (sentence) => sentence[0].toLowerCase() + sentence.slice(1);
