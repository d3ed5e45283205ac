// The charts: what the reader chose to see over time, all under one cursor.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { onTheme } from "../theme.js";
import { onUnits } from "../units.js";
import { ChartDialog } from "./chart-dialog.js";
import { Chart } from "./chart.js";
import { empty, explain, painted } from "./dom.js";
import { quantities, rowsOf } from "./plotted.js";

const KEY = "seacage-charts";
const DEFAULT_KINDS = new Set(["depths", "shackles"]);

export class Charts {
  constructor(holder, model, past) {
    Object.assign(this, { model, past, charts: new Map(), shown: false });
    this.choice = make("div", { className: "chart-choice" });
    this.count = make("span", { className: "count" });
    this.grid = make("div", { className: "chart-grid" });
    this.none = make("div");
    holder.append(
      make("details", { className: "chooser" }, make("summary", {}, text("charts.choose"), this.count),
        this.choice),
      explain({ curve: "twin", band: "interval", dash: "simulated", dot: "measured" }),
      this.none, this.grid);
    this.large = new ChartDialog({ closed: () => this.arrange() });
    this.paint = painted(() => this.show());
    model.on("topology", () => this.topology());
    for (const name of ["view", "connection"]) model.on(name, () => this.paint());
    past.on(() => this.paint());
    model.on("selection", () => this.mark());
    onUnits(() => this.topology()); // whose texts and scales are made with a chart
    onTheme(() => this.charts.forEach((chart) => chart.repaint()));
    this.topology();
  }

  /** Whether anybody sees the charts: nothing is drawn that nobody sees. */
  visible(shown) {
    this.shown = shown;
    if (shown) this.paint();
  }

  topology() {
    const { topology } = this.model;
    if (!topology) return;
    this.all = quantities(topology);
    const kept = (localStorage.getItem(KEY) ?? "").split(" ");
    const known = kept.filter((key) => this.all.some((one) => one.key === key));
    this.chosen = new Set(known.length ? known
      : this.all.filter(({ kind }) => DEFAULT_KINDS.has(kind)).map(({ key }) => key));
    this.large.close();
    this.charts.forEach((chart) => chart.remove());
    this.charts.clear();
    this.offer();
    this.arrange();
  }

  offer() {
    const kinds = [...new Set(this.all.map(({ kind }) => kind))];
    this.choice.replaceChildren(...kinds.map((kind) => make("fieldset", {},
      make("legend", {}, text(`charts.kind.${kind}`)),
      ...this.all.filter((one) => one.kind === kind).map((one) => this.box(one)))));
  }

  box({ key, title }) {
    const input = make("input", { type: "checkbox", checked: this.chosen.has(key) });
    input.addEventListener("change", () => {
      if (input.checked) this.chosen.add(key);
      else this.chosen.delete(key);
      localStorage.setItem(KEY, [...this.chosen].join(" "));
      this.arrange();
    });
    return make("label", { className: "pill" }, input, make("span", {}, title));
  }

  /** Make the charts that were chosen and are not there, and remove the others. */
  arrange() {
    for (const [key, chart] of this.charts) {
      if (this.chosen.has(key)) continue;
      chart.remove();
      this.charts.delete(key);
    }
    const travel = (t) => this.model.travel(new Date(1000 * t)).catch((error) => this.model.complain(error));
    const { cage, origin } = this.model.topology;
    const cards = this.all.filter(({ key }) => this.chosen.has(key)).map((quantity) => {
      const chart = this.charts.get(quantity.key) ?? new Chart(quantity, {
        sync: "past", travel, about: { cage, origin }, enlarge: (one) => this.large.turn(one),
      });
      this.charts.set(quantity.key, chart);
      return chart.card;
    });
    this.grid.replaceChildren(...cards);
    this.mark();
    this.count.textContent = text("charts.chosen", { count: cards.length, all: this.all.length });
    this.paint();
  }

  /** Mark the charts of what is chosen on the net. */
  mark() {
    const { bridle, sensor } = this.model.selection ?? {};
    for (const [key, { card }] of this.charts) {
      card.toggleAttribute("data-chosen", key === `bridle:${bridle}` || key === `sensor:${sensor}`);
    }
  }

  show() {
    if (!this.shown || !this.all) return;
    const { columns } = this.past;
    const why = this.missing(columns);
    this.none.replaceChildren(...(why ? [why] : []));
    this.grid.hidden = Boolean(why);
    if (why) return;
    const { view, topology } = this.model;
    const at = view?.mode === "past" ? view.t / 1000 : null;
    const window = {
      start: this.past.start / 1000, end: this.past.end / 1000, gap: topology.stale_after_s, at,
    };
    for (const chart of this.charts.values()) {
      chart.fit();
      chart.show(rowsOf(columns, chart.quantity), window);
    }
  }

  missing(columns) {
    if (this.past.fault && !columns) return empty(text("charts.failed"), this.past.fault);
    if (!columns) return empty(text("charts.loading"), text("charts.asking"));
    if (!columns.t.length && Object.values(columns.measured).every(({ t }) => !t.length)) {
      return empty(text("charts.empty"), text("charts.begin"));
    }
    if (!this.charts.size) return empty(text("charts.none"), text("charts.above"));
    return null;
  }
}
