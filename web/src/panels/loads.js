// The loads: the rose and, beside it, the same in numbers.

import { make } from "../dom.js";
import { chosenLine, kindOf, kindsOf, selectionOf } from "../lines.js";
import { bridleColours } from "../scene/paint.js";
import { noSpread } from "../scene/words.js";
import { text } from "../texts/index.js";
import { onTheme, styled } from "../theme.js";
import { shown, unitName } from "../units.js";
import { explain, tableHead, write } from "./dom.js";
import { amount, half, known, percent, plain, spoken, titled, withUnit } from "./format.js";
import { LineTable } from "./line-table.js";
import { largest, loadRows, otherRows } from "./load-rows.js";
import { PartedTable } from "./parted-table.js";
import { around } from "./rose-shape.js";
import { Rose } from "./rose.js";
import { scaleFor } from "./scale.js";

const BRIDLE = "bridle";

export class Loads {
  constructor(holder, model, parting) {
    Object.assign(this, { model, kind: BRIDLE });
    const pick = (name) => model.select(selectionOf(model.topology, name));
    this.rose = new Rose({ pick });
    this.kinds = make("div", { className: "kinds", role: "group", ariaLabel: text("loads.kinds") });
    this.body = make("tbody");
    this.caption = make("p", { className: "aside" });
    this.lines = new LineTable({ pick });
    const parted = new PartedTable(model, parting);
    this.table = make("table", { className: "loads" },
      make("caption", { className: "unseen" }, text("loads.caption")),
      tableHead(["bridle", "twin", "simulated", "measured", "share"].map((head) => text(`loads.heads.${head}`))),
      this.body);
    this.legend = explain(
      { bar: "twin", whisker: "interval", ghost: "maximum", tick: "simulated", dot: "measured" });
    holder.append(
      this.kinds, make("div", { className: "rose-holder" }, this.rose.drawing), this.legend,
      make("div", { className: "table-holder" }, this.table), this.caption, this.lines.drawing, parted.drawing);
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
    this.offer(topology);
    this.rows = topology.bridle_names.map((name, k) => this.row(name, k, topology));
    this.body.replaceChildren(...this.rows.map(({ row }) => row));
    this.show();
    this.select();
  }

  /** Offer the kinds of lines that the rose can show. */
  offer(topology) {
    const kinds = kindsOf(topology);
    this.kinds.hidden = kinds.length < 2;
    this.kinds.replaceChildren(...kinds.map((kind) => {
      const button = make("button", { type: "button", onclick: () => this.turn(kind) }, text(`loads.kind.${kind.replace(" ", "-")}`));
      button.dataset.kind = kind;
      return button;
    }));
    this.turn(BRIDLE);
  }

  /** Show the lines of a kind on the rose. */
  turn(kind) {
    this.kind = kind;
    for (const button of this.kinds.children) button.ariaPressed = String(button.dataset.kind === kind);
    this.scales = undefined;
    this.rose.lines(around(this.model.topology, kind));
    this.rose.select(chosenLine(this.model.selection));
    this.show();
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
    const others = this.kind === BRIDLE ? null : this.others(view.state);
    this.lines.show(view.state);
    this.legend.querySelector(".ghost").parentElement.hidden = !view.state.lines?.length;
    const water = view.state.valid ? view.state.water : null;
    this.rose.show({
      loads: others ?? loads, end: others ? this.scales : this.end, unit: others ? unitName("kN") : "%",
      current: water?.current_to_deg, wave: water?.wave_from_deg,
      words: others ? otherWords(others, text(`loads.kind.${this.kind.replace(" ", "-")}`)) : roseWords(loads, water),
    });
    loads.forEach((load, k) => fill(this.rows[k], load, this.end));
    const limits = topology.bridle_capacity_kn;
    const [lower, upper] = [Math.min(...limits), Math.max(...limits)].map((kn) => amount(kn, "kN", 0));
    const capacity = text("loads.capacity", { unit: unitName("kN"),
      capacity: lower === upper ? upper : text("number.range", { lower, upper }) });
    const reason = loads.find(({ kn, interval }) => known(kn) && !interval)?.reason;
    const shape = view.position && !view.sigma ? noSpread(view.state) : "";
    write(this.caption, [capacity, reason && text("loads.noIntervalWhy", { reason: lowered(reason) }),
      shape && text("loads.noSpreadWhy", { reason: lowered(shape) })].filter(Boolean).join(" "));
  }

  /** Rows of the lines on the rose where they are no bridles, on a scale of hundreds of the unit of force. */
  others(state) {
    const names = this.rose.parts.map(({ name }) => name);
    const rows = otherRows(names, state, (kn) => (known(kn) ? shown(kn, "kN") / 100 : null), styled("--mean"));
    this.scales = scaleFor(largest(rows), this.scales);
    return rows;
  }

  select() {
    const { topology, selection } = this.model;
    const chosen = chosenLine(selection);
    const kind = chosen && topology && kindOf(topology, chosen);
    if (kind && kind !== this.kind) this.turn(kind);
    this.rose.select(chosen);
    this.lines.select(chosen);
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
  twin.replaceChildren(make("b", {}, amount(load.kn, "kN")),
    make("span", { className: "pm" }, half(load.interval, "kN")));
  twin.title = known(load.kn) && !load.interval ? load.reason || text("loads.noInterval") : "";
  write(low, amount(load.lowKn, "kN"));
  write(measured, load.shackle ? amount(load.measuredKn, "kN") : "");
  measured.title = load.shackle && !known(load.measuredKn)
    ? text("loads.noReading", { shackle: plain(load.shackle) }) : "";
  write(share, percent(load.top));
  bar.style.width = `${Math.min(100, (100 * (load.top ?? 0)) / Math.max(1, end))}%`;
  bar.style.backgroundColor = known(load.top) ? load.colour : "";
  row.dataset.rank = load.rank ?? "";
}

function otherWords(loads, kind) {
  const loaded = loads.filter(({ maximumKn, kn }) => known(maximumKn ?? kn));
  if (!loaded.length) return text("loads.noRose");
  const size = ({ maximumKn, kn }) => maximumKn ?? kn;
  const most = loaded.reduce((a, b) => (size(b) > size(a) ? b : a));
  return text("loads.roseOthers", { kind, name: plain(most.name), load: withUnit(size(most), "kN") });
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
