// One quantity over time: simulation alone, the twin with its interval, and what was measured.

import uPlot from "uplot";

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { styled } from "../theme.js";
import { decimalsIn, shown, unitName, zone } from "../units.js";
import { csvOf, pictureOf, save } from "./chart-file.js";
import { write } from "./dom.js";
import { dayOfYear, fixed, half, known, moment, time } from "./format.js";
import { icon } from "./icons.js";
import { joined, nearest, widened } from "./plotted.js";

const HEIGHT = 138;
const [LOWER, UPPER, MEASURED, LOW, MEAN] = [1, 2, 3, 4, 5];

export class Chart {
  /**
   * `travel` is called with the time [s] that the reader chose, `enlarge` with the chart that is to
   * be large or small again; `about` says of what cage it is: {cage, origin}.
   */
  constructor(quantity, { sync, travel, enlarge, about }) {
    Object.assign(this, { quantity, about, height: HEIGHT });
    this.now = make("p", { className: "chart-now" });
    this.area = make("div", {
      className: "chart-area", tabIndex: 0, role: "group",
      ariaLabel: text("charts.label", { name: quantity.title }),
    });
    this.read = make("p", { className: "unseen", ariaLive: "polite" });
    const head = make("header", {}, make("h3", {}, quantity.title,
      make("small", {}, quantity.place)), this.now, this.tools(enlarge));
    this.card = make("article", { className: "chart" }, head, this.area, this.read);
    this.card.dataset.key = quantity.key;
    this.travel = travel;
    this.plot = new uPlot(this.options(sync), [[], [], [], [], [], []], this.area);
    this.sizes = new ResizeObserver(() => this.fit());
    this.sizes.observe(this.area);
    this.area.addEventListener("keydown", (event) => this.key(event));
    this.area.addEventListener("blur", () => this.plot.setCursor({ left: -10, top: -10 }));
    this.plot.over.addEventListener("click", () => this.chosen());
  }

  tools(enlarge) {
    const { title } = this.quantity;
    const button = (name, onclick) => make("button", { type: "button", className: "round small", onclick,
      title: text(`charts.${name}`), ariaLabel: text(`charts.${name}Of`, { name: title }) }, icon(name));
    this.larger = button("enlarge", () => enlarge(this));
    this.larger.ariaPressed = "false";
    return make("div", { className: "chart-tools" }, button("picture", () => this.save("png")),
      button("table", () => this.save("csv")), this.larger);
  }

  /** Be as high as this [px]; null as in the grid. */
  grow(height) {
    this.height = height ?? HEIGHT;
    this.larger.ariaPressed = String(height !== null);
    this.fit();
  }

  /** Hand what is shown to the reader as a file. */
  async save(kind) {
    if (!this.rows) return;
    const { quantity: { name, title, unit }, about, window: [start, end] } = this;
    const blob = kind === "csv" ? new Blob([csvOf(this.rows, { unit, origin: about.origin })], { type: "text/csv" })
      : await pictureOf(this.plot, { title, unit, ...about, start: 1000 * start, end: 1000 * end });
    save(`${about.cage}_${name}_${new Date(1000 * end).toISOString().slice(0, 10)}.${kind}`, blob);
  }

  options(sync) {
    const { unit, downwards } = this.quantity;
    const axis = {
      stroke: () => styled("--muted"), font: `11px ${styled("--font")}`,
      grid: { stroke: () => styled("--edge"), width: 1 }, ticks: { show: false },
    };
    return {
      width: 320, height: HEIGHT, padding: [8, 24, 0, 0],
      tzDate: (t) => uPlot.tzDate(new Date(t * 1000), zone()),
      legend: { show: false },
      cursor: { y: false, drag: { x: false, y: false }, sync: { key: sync }, points: { size: 7 } },
      scales: {
        x: { time: true, range: () => this.window ?? [0, 1] },
        y: { dir: downwards ? -1 : 1, range: (_, low, high) => widened(low, high) },
      },
      axes: [
        { ...axis, space: 70, size: 24, values: stamps },
        { ...axis, size: 46, space: 28, values: (_, marks) => marks.map((m) => fixed(m, places(marks))) },
      ],
      series: [{}, hidden("lower"), hidden("upper"),
        { label: text("mark.measured"), stroke: () => styled("--measured"), paths: () => null,
          points: { show: true, size: 3.5, width: 0, fill: () => styled("--measured") } },
        { ...line(text("mark.simulated"), "--low", 1.3), dash: [5, 4] },
        line(`${text("mark.twin")} [${unitName(unit)}]`, "--mean", 1.8)],
      bands: [{ series: [UPPER, LOWER], fill: () => styled("--band") }],
      hooks: { setCursor: [() => this.report()], draw: [(plot) => this.mark(plot)] },
    };
  }

  /** Show rows over a window of time [s]; `at` is marked where the reader has travelled there. */
  show(rows, { start, end, gap, at }) {
    this.window = [start, end];
    this.at = at;
    const { unit } = this.quantity;
    this.rows = joined(rows, gap).map((column, k) => (k ? column.map((value) => shown(value, unit)) : column));
    this.plot.setData(this.rows);
    this.report();
  }

  /** Take the colours of the theme. */
  repaint() {
    this.plot.redraw(false);
  }

  fit() {
    const width = Math.floor(this.area.clientWidth);
    const { height } = this;
    if (width > 0 && (width !== this.plot.width || height !== this.plot.height)) this.plot.setSize({ width, height });
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -24, PageDown: 24 }[event.key];
    const times = this.rows?.[0] ?? [];
    if (event.key === "Enter") this.chosen();
    if (!step || !times.length) return;
    event.preventDefault();
    const present = this.plot.cursor.idx ?? times.length - 1;
    const next = Math.min(times.length - 1, Math.max(0, present + step));
    this.plot.setCursor({ left: this.plot.valToPos(times[next], "x"), top: 10 });
    write(this.read, this.now.textContent);
  }

  chosen() {
    const { left } = this.plot.cursor;
    if (left >= 0) this.travel(this.plot.posToVal(left, "x"));
  }

  /** Say what the curves say at the cursor, or where it is not, at the end. */
  report() {
    if (!this.rows) return;
    const pointed = this.plot.cursor.left >= 0;
    const at = pointed ? this.plot.posToVal(this.plot.cursor.left, "x") : this.at ?? this.window[1];
    const { unit } = this.quantity;
    const decimals = decimalsIn(unit, { m: 2, "m/s": 2, kN: 1, "%": 1 }[unit]);
    const k = this.lastBefore(MEAN, at);
    const mean = k < 0 ? null : this.rows[MEAN][k];
    const read = this.lastBefore(MEASURED, at);
    const measured = read < 0 ? null : this.rows[MEASURED][read];
    const interval = { mean, lower: this.rows[LOWER][k], upper: this.rows[UPPER][k] };
    const when = pointed && k >= 0 ? `${time(1000 * this.rows[0][k])}  ` : "";
    this.now.replaceChildren(when, make("b", {}, fixed(mean, decimals)),
      make("span", { className: "pm" }, ` ${half(interval, "", decimals)} ${known(mean) ? unitName(unit) : ""}`),
      known(measured) ? make("span", { className: "read" },
        `  ${text("charts.measured", { value: fixed(measured, decimals) })}`) : "");
    this.now.title = k < 0 ? "" : moment(1000 * this.rows[0][k]);
  }

  /** The row nearest to a time that has something to say in a column; -1 if none is near. */
  lastBefore(column, t) {
    const [times, values] = [this.rows[0], this.rows[column]];
    const reach = (this.window[1] - this.window[0]) / 40;
    for (let k = nearest(times, t); k >= 0 && t - times[k] < reach; k -= 1) {
      if (values[k] === null && column === MEAN) return -1;
      if (known(values[k])) return k;
    }
    return -1;
  }

  /** Mark the time to which the reader has travelled. */
  mark({ ctx, bbox }) {
    if (!this.at) return;
    const x = Math.round(this.plot.valToPos(this.at, "x", true));
    ctx.save();
    ctx.strokeStyle = styled("--past");
    ctx.lineWidth = 2;
    ctx.setLineDash([2, 3]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  remove() {
    this.sizes.disconnect();
    this.plot.destroy();
    this.card.remove();
  }
}

const hidden = (label) => ({ label, stroke: "transparent", width: 0, points: { show: false } });

const line = (label, colour, width) => ({ label, stroke: () => styled(colour), width, points: { show: false } });

/** So many decimals as the step between two marks has. */
const places = ([first, second]) =>
  String(Number(((second ?? first) - first).toFixed(6))).split(".")[1]?.length ?? 0;

/** Times below a chart: the time of day, and the day where it begins or days are far apart. */
function stamps(_, marks) {
  const daily = marks.length > 1 && marks[1] - marks[0] >= 86400;
  return marks.map((t, k) => {
    const [date, clock] = [dayOfYear(1000 * t), time(1000 * t)];
    if (daily) return date;
    return k === 0 || clock === "00:00" ? `${date} ${clock}` : clock;
  });
}
