// The first line: what an operator has to know in three seconds.

import { make } from "./dom.js";
import { ago, bearing, compass, fixed, half, percent } from "./format.js";

const NEAR = 0.8;

export class Verdict {
  constructor(holder) {
    this.holder = holder;
  }

  topology(topology) {
    this.graph = topology;
  }

  show({ state, position_mm: position, sigma_mm: sigma }) {
    this.holder.replaceChildren(
      make("div", { className: "headline" }),
      current(state), highest(state), volume(state), this.bottom(state, position, sigma),
    );
    this.say(judged(state));
  }

  /** What is shown is no longer now. */
  lost(when) {
    this.say({ kind: "silent", headline: "Connection lost", detail: `What is shown is ${when}.` });
  }

  say({ kind, headline, detail }) {
    this.holder.dataset.kind = kind;
    this.holder.querySelector(".headline")
      ?.replaceChildren(make("h2", {}, headline), make("p", {}, detail));
  }

  /** How deep the net hangs: as a sensor there has taught, else as simulated. */
  bottom({ sensors, valid }, position, sigma) {
    if (!valid) return figure("Net bottom", "–", "", "");
    const node = this.graph.rest_position_m.length - 1;
    const there = this.graph.depth_sensors.find((sensor) => sensor.node === node)?.name;
    const [depth, spread] = [-position[3 * node + 2], 1.96 * sigma[node]].map((mm) => mm / 1000);
    const { mean, lower, upper } = sensors.find(({ name }) => name === there) ??
      { mean: depth, lower: depth - spread, upper: depth + spread };
    const lift = -this.graph.rest_position_m[node][2] - mean;
    return figure("Net bottom", fixed(mean), `${half({ lower, upper })} m deep`,
      `${fixed(Math.abs(lift))} m ${lift >= 0 ? "above" : "below"} where it rests`);
  }
}

/** One sentence on the whole, and whether it needs a person. */
function judged(state) {
  if (!state.valid) {
    return { kind: "silent", headline: "No valid input", detail: `${state.reason} No loads are shown.` };
  }
  const top = Math.max(...state.bridles.map(({ utilisation }) => utilisation));
  const input = `Input ${ago(state.age_s)} old, ` +
    (state.in_domain ? "within what the twin has learned." : "beyond what the twin has learned.");
  if (top >= 1) return { kind: "over", headline: "A bridle is beyond its capacity", detail: input };
  if (top >= NEAR) return { kind: "near", headline: "A bridle nears its capacity", detail: input };
  if (!state.in_domain) {
    return { kind: "beyond", headline: "Beyond what was learned", detail: `${state.reason}` };
  }
  return { kind: "calm", headline: "All loads within capacity", detail: input };
}

function current({ water, valid }) {
  if (!valid) return figure("Current", "–", "", "");
  const to = water.current_to_deg;
  const value = figure("Current", fixed(water.current_speed_m_s, 2), "m/s",
    `towards ${bearing(to)} ${compass(to)}`);
  const needle = make("span", { className: "needle", ariaHidden: "true" });
  needle.style.transform = `rotate(${to}deg)`;
  value.querySelector("b").before(needle);
  return value;
}

function highest({ bridles, valid }) {
  if (!valid) return figure("Highest load", "–", "", "");
  const top = bridles.reduce((a, b) => (b.utilisation > a.utilisation ? b : a));
  return figure("Highest load", fixed(top.tension_kn.mean), `${half(top.tension_kn)} kN`,
    `${top.name.replace("-", " ")}, ${percent(top.utilisation)} of capacity`);
}

function volume({ volume_fraction: share }) {
  const lost = share === null ? "" : "of the volume in still water";
  return figure("Cage volume", share === null ? "–" : String(Math.round(100 * share)),
    share === null ? "" : "%", lost);
}

function figure(name, value, unit, note) {
  return make("div", { className: "figure" },
    make("h3", {}, name),
    make("p", { className: "value" }, make("b", {}, value), unit ? make("span", {}, ` ${unit}`) : ""),
    make("p", { className: "note" }, note));
}
