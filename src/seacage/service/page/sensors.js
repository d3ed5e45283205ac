// The sensors: what each should read, what it does read, and the last day of both.

import { Chart } from "./chart.js";
import { explain, make } from "./dom.js";
import { fixed, half, time } from "./format.js";

const SPAN = 24 * 3600e3;
const FAIL = 4; // of QARTOD
const STEP = 60e3; // the newest points of a curve are at least so far apart

export class Sensors {
  constructor({ grid, legend }) {
    this.grid = grid;
    explain(legend, {
      curve: "twin", band: "95 % interval", low: "simulation alone", dot: "measured",
    });
  }

  topology({ depth_sensors: depths, shackles, rest_position_m: rest }) {
    const places = [
      ...depths.map(({ name, node }) => [name, `rests at ${fixed(-rest[node][2])} m`, true]),
      ...shackles.map(({ name, bridle }) => [name, `on bridle ${bridle + 1}`, false]),
    ];
    this.cards = new Map(places.map(([name, place, deep]) => [name, this.card(name, place, deep)]));
    this.grid.replaceChildren(...[...this.cards.values()].map(({ card }) => card));
  }

  card(name, place, downwards) {
    const [now, read] = ["now", "read"].map((kind) => make("p", { className: kind }));
    const canvas = make("canvas", { role: "img" });
    const head = make("h3", {}, name.replace("-", " "), make("small", {}, place));
    const card = make("article", { className: "sensor" }, head, now, read, canvas);
    const chart = new Chart(canvas, { downwards, read: (point) => this.hover(name, point) });
    return { card, now, read, canvas, chart, twin: [], measured: [] };
  }

  /** Take the past, in place of what was there. */
  history({ t, sensors, measured }) {
    const times = t.map(Date.parse);
    for (const [name, one] of this.cards) {
      const series = sensors[name];
      one.twin = times.map((when, k) => ({
        t: when, low: series.low_fidelity[k], mean: series.mean[k],
        lower: series.lower[k], upper: series.upper[k],
      }));
      const seen = measured[name];
      one.measured = seen.t.map((when, k) => ({ t: Date.parse(when), value: seen.value[k] }));
      this.trim(one, times.at(-1) ?? 0);
    }
  }

  show(state) {
    const now = Date.parse(state.t);
    const failed = state.amended.filter(({ flag }) => flag >= FAIL);
    for (const sensor of state.sensors) {
      const one = this.cards.get(sensor.name);
      const { low_fidelity: low, mean, lower, upper, measured, measured_age_s: age } = sensor;
      append(one.twin, { t: now, low, mean, lower, upper });
      if (measured !== null) {
        append(one.measured, { t: now - 1e3 * age, value: measured });
      }
      for (const spike of failed.filter(({ stream }) => stream === sensor.name)) {
        const at = Date.parse(spike.t);
        one.measured = one.measured.filter(({ t }) => Math.abs(t - at) > 2); // ages are rounded
      }
      this.trim(one, now);
      Object.assign(one, { sensor });
      this.write(one);
      one.chart.show({ twin: one.twin, measured: one.measured, start: now - SPAN, end: now });
    }
  }

  trim(one, now) {
    const recent = ({ t }) => t >= now - SPAN && t <= now;
    one.twin = one.twin.filter(recent);
    one.measured = one.measured.filter(recent);
  }

  write({ sensor, now, read, canvas, card }) {
    const { mean, lower, upper, measured, unit, name } = sensor;
    const decimals = unit === "m" ? 2 : 1;
    now.replaceChildren(
      make("b", {}, fixed(mean, decimals)),
      make("span", { className: "pm" }, `${half(sensor, decimals)} ${mean === null ? "" : unit}`));
    const inside = measured !== null && mean !== null && measured >= lower && measured <= upper;
    const verdict = mean === null ? "" : inside ? ", as expected" : ", outside the interval";
    const words = measured === null ? "no reading now" : `reads ${fixed(measured, decimals)}${verdict}`;
    if (!read.dataset.pointed) read.textContent = words;
    read.classList.toggle("outside", measured !== null && mean !== null && !inside);
    card.classList.toggle("level-1", sensor.level === 1);
    canvas.setAttribute("aria-label", `${name}, last 24 hours: twin ${fixed(mean, decimals)} ` +
      `${half(sensor, decimals)} ${unit}, ${words}. Arrow keys read the curve.`);
  }

  /** Say what the curve says where the reader points. */
  hover(name, point) {
    const { read, sensor } = this.cards.get(name);
    const decimals = sensor?.unit === "m" ? 2 : 1;
    if (point) {
      read.dataset.pointed = true;
      read.textContent = `${time(point.t)}: twin ${fixed(point.mean, decimals)} ` +
        `${half(point, decimals)}, simulation ${fixed(point.low, decimals)}` +
        (point.measured === null ? "" : `, measured ${fixed(point.measured, decimals)}`);
    } else if (sensor) {
      delete read.dataset.pointed;
      this.write(this.cards.get(name));
    }
  }
}

/** Add a point, in place of the last one where that is not old enough to be kept. */
function append(points, point) {
  const before = points.at(-2);
  if (before && points.at(-1).fresh && point.t - before.t < STEP) points.pop();
  points.push({ ...point, fresh: true });
}
