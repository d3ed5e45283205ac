// The net from the side and from above, drawn flat, with a table: for browsers without WebGL,
// and for readers who like it better.

import { draw, make } from "../dom.js";
import { tableHead } from "../panels/dom.js";
import { amount, bearing, compass, withUnit } from "../panels/format.js";
import { text } from "../texts/index.js";
import { onTheme } from "../theme.js";
import { unitName } from "../units.js";
import { SLACK_M_S, extent, ringNodes, towards, tubeRing } from "./geometry.js";
import { sensorPlaces } from "./places.js";
import { bridleColours, sensorColour } from "./paint.js";
import { band, outline } from "./silhouette.js";
import { Tip } from "./tip.js";
import { wavesOf } from "./waves.js";
import { wordsFor } from "./words.js";

const PAD = 5; // metres around the drawing

export class FlatView {
  constructor(model, options, holder) {
    Object.assign(this, { model, options, holder });
    this.side = drawing(text("flat.side"));
    this.plan = drawing(text("flat.plan"));
    this.heading = 90; // that the side view looks across [compass degrees]
    this.table = make("table", { className: "flat-table" });
    this.element = make("div", { className: "flat", tabIndex: 0, role: "group",
      "aria-label": text("flat.both") },
    this.side.figure, make("div", { className: "flat-words" }, this.table), this.plan.figure);
    this.side.figure.className = "flat-side";
    holder.append(this.element);
    this.tip = new Tip(holder);
    for (const { svg } of [this.side, this.plan]) this.listen(svg);
    this.forget = [
      model.on("topology", (topology) => this.build(topology)),
      model.on("view", () => this.show()),
      model.on("selection", () => this.show()),
      options.on(() => this.show()),
      onTheme(() => this.show()),
    ];
    if (model.topology) this.build(model.topology);
  }

  build(topology) {
    this.topology = topology;
    const aside = topology.corner_position_m.flat().filter((_, k) => k % 3 < 2).map(Math.abs);
    const reach = Math.max(...aside, 0.72 * extent(topology).frame) + PAD;
    this.plan.svg.setAttribute("viewBox", `${-reach} ${-reach} ${2 * reach} ${2 * reach}`);
    this.show();
  }

  /** Turn the side view across the current, which then goes to the right; the last way in none. */
  turn(view) {
    const water = view?.state.valid ? view.state.water : null;
    const flows = water?.current_speed_m_s > SLACK_M_S && Number.isFinite(water.current_to_deg);
    if (flows) this.heading = water.current_to_deg;
    const [east, north] = towards(this.heading);
    const along = ([x, y]) => x * east + y * north;
    const { depth, reach: net } = extent(this.topology);
    const reach = Math.max(net, ...this.topology.corner_position_m.map((one) => Math.abs(along(one)))) + PAD;
    this.side.svg.setAttribute("viewBox", `${-reach} ${-PAD} ${2 * reach} ${1.12 * depth + PAD}`);
    const way = `${bearing(this.heading)} ${compass(this.heading)}`;
    this.side.caption.textContent = flows
      ? text("flat.across", { way }) : text("flat.still", { way });
    return ([x, y, z]) => [along([x, y]), -z];
  }

  show() {
    const { topology, model } = this;
    if (!topology) return;
    const view = model.view;
    const position = view?.position ?? topology.rest;
    const seen = { topology, view, position, options: this.options, chosen: model.selection };
    this.side.svg.replaceChildren(...sketch(seen, this.turn(view), "side"));
    this.plan.svg.replaceChildren(...sketch(seen, ([x, y]) => [x, -y], "plan"));
    this.fill(view);
  }

  /** Listen on the whole drawing, whose lines are drawn anew with each state. */
  listen(svg) {
    const named = ({ target }) => {
      const { kind, name } = target.closest("[data-name]")?.dataset ?? {};
      return name ? { [kind]: name } : null;
    };
    svg.addEventListener("click", (event) => this.model.select(named(event)));
    svg.addEventListener("pointerleave", () => this.tip.show(null));
    svg.addEventListener("pointermove", (event) => {
      const box = this.holder.getBoundingClientRect();
      const words = wordsFor(named(event), this.topology, this.model.view);
      this.tip.show(words, [event.clientX - box.left, event.clientY - box.top]);
    });
  }

  /** Where the net is, in numbers. */
  fill(view) {
    const { topology } = this;
    const { spokes, rings, rest } = topology;
    const places = [["collar", 0], ["tube", tubeRing(topology)], ["tip", null]];
    const rows = places.map(([name, ring]) => {
      const nodes = ring === null ? [spokes * rings] : ringNodes(topology, ring);
      const mean = (array, axis) =>
        nodes.reduce((sum, node) => sum + array[3 * node + axis], 0) / nodes.length;
      const position = view?.position;
      const moved = position && [0, 1, 2].map((axis) => mean(position, axis) - mean(rest, axis));
      const sigma = position && view.sigma
        && nodes.reduce((most, node) => Math.max(most, view.sigma[node]), 0);
      const aside = moved && Math.hypot(moved[0], moved[1]);
      return [text(`flat.ring.${name}`), amount(position && -mean(position, 2), "m"), amount(aside, "m"),
        amount(moved && moved[2], "m"), amount(sigma, "m", 2)];
    });
    this.table.replaceChildren(
      make("caption", { className: "unseen" }, text("flat.caption")),
      tableHead(["where", "depth", "aside", "raised", "sigma"].map((head) => text(`flat.heads.${head}`, { unit: unitName("m") }))),
      make("tbody", {}, ...rows.map(([name, ...cells]) => make("tr", {},
        make("th", { scope: "row" }, name), ...cells.map((cell) => make("td", {}, cell))))));
  }

  look() {}

  close() {
    for (const stop of this.forget) stop();
    this.holder.replaceChildren();
  }
}

function drawing(caption) {
  const svg = draw("svg", { role: "img", "aria-label": caption, class: "flat-drawing",
    preserveAspectRatio: "xMidYMid meet" });
  const words = make("figcaption", {}, caption);
  return { svg, caption: words, figure: make("figure", {}, svg, words) };
}

function sketch({ topology, view, position, options, chosen }, project, kind) {
  const at = (array, node) => project([array[3 * node], array[3 * node + 1], array[3 * node + 2]]);
  const path = (array, edges) => edges.map(([a, b]) =>
    `M${at(array, a).map(short).join(" ")}L${at(array, b).map(short).join(" ")}`).join("");
  const loop = (ring) => `M${ringNodes(topology, ring)
    .map((node) => at(position, node).map(short).join(" ")).join("L")}Z`;
  const parts = [];
  if (kind === "side") {
    const { frame } = extent(topology);
    parts.push(draw("path", { d: surface(topology, view, project, 2 * frame), class: "flat-sea" }));
  } else parts.push(...north(topology));
  parts.push(mooring(topology, project));
  if (options.ghost && view?.position) {
    parts.push(draw("path", { d: path(topology.rest, topology.edges), class: "flat-ghost" }));
  }
  if (options.shell && view?.position && view.sigma) {
    const line = (net) => (kind === "side" ? outline(topology, net, project)
      : ringNodes(topology, tubeRing(topology)).map((node) => at(net, node)));
    const d = band(topology, position, view.sigma, line)
      .map((points) => `M${points.map((one) => one.map(short).join(" ")).join("L")}Z`).join("");
    parts.push(draw("path", { d, class: "flat-band", "fill-rule": "evenodd" }));
  }
  parts.push(draw("path", { d: path(position, topology.edges), class: "flat-net" }),
    draw("path", { d: loop(tubeRing(topology)), class: "flat-tube" }));
  parts.push(draw("path", { d: loop(0), class: "flat-collar" }));
  for (const { name, ends_m: ends } of topology.lines ?? []) {
    const [[x1, y1], [x2, y2]] = ends.map(project);
    parts.push(draw("line", { x1, y1, x2, y2, class: `flat-line ${chosen?.line === name ? "chosen" : ""}`,
      "data-kind": "line", "data-name": name }));
  }
  const colours = bridleColours(topology, view, options);
  topology.bridle_names.forEach((name, k) => {
    const from = project(topology.corner_position_m[topology.bridle_corners[k]]);
    const to = at(position, topology.bridle_nodes[k]);
    parts.push(draw("line", { x1: from[0], y1: from[1], x2: to[0], y2: to[1],
      class: `flat-bridle ${chosen?.bridle === name ? "chosen" : ""}`, stroke: colours[k],
      "data-kind": "bridle", "data-name": name }));
  });
  for (const { name, at: place } of sensorPlaces(topology, position)) {
    const [cx, cy] = project(place);
    const r = chosen?.sensor === name ? 1.7 : 1.1;
    parts.push(draw("circle", { cx, cy, r, class: "flat-sensor", fill: sensorColour(view, name),
      "data-kind": "sensor", "data-name": name }));
  }
  const water = view?.state.valid ? view.state.water : null;
  if (water?.current_speed_m_s > SLACK_M_S) parts.push(arrow(topology, water, project));
  return parts;
}

/** The sea's surface across a side view, in the phase with a crest in the middle. */
function surface(topology, view, project, reach) {
  const waves = wavesOf(view?.state.valid ? view.state.water : null, topology.water_depth_m);
  if (!waves) return `M${-reach} 0H${reach}`;
  // Cut obliquely, waves are longer; along their crests they are level.
  const [along] = project([...towards(waves.from), 0]);
  const rise = (x) => -0.5 * waves.height * Math.cos(waves.number * along * x);
  const points = Array.from({ length: 2 * reach + 1 }, (_, k) => k - reach);
  return `M${points.map((x) => `${short(x)} ${short(rise(x))}`).join("L")}`;
}

/** The edge of the plan to which north is. */
function north(topology) {
  const edge = Math.max(...topology.corner_position_m.map(([, y]) => y));
  return [draw("text", { x: 0, y: -edge - 2, class: "flat-name" }, compass(0))];
}

function mooring({ corner_position_m: corners }, project) {
  const d = corners.map((corner, k) => {
    const places = [corner, corners[(k + 1) % corners.length], [corner[0], corner[1], 0]];
    const [at, next, top] = places.map((place) => project(place).map(short).join(" "));
    return `M${at}L${next}M${at}L${top}`;
  }).join("");
  return draw("path", { d, class: "flat-frame" });
}

function arrow(topology, water, project) {
  const { reach, depth } = extent(topology);
  const [east, north] = towards(water.current_to_deg);
  const length = Math.max(4, 22 * water.current_speed_m_s);
  const along = (metres) => project([metres * east, metres * north, -0.62 * depth]);
  const [from, to] = [along(-reach - 3 - length), along(-reach - 3)];
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const size = Math.hypot(dx, dy);
  if (size < 1) return draw("g");
  const [u, v] = [dx / size, dy / size];
  const barb = (side) =>
    [to[0] - 3 * u + 1.4 * side * v, to[1] - 3 * v - 1.4 * side * u].map(short).join(" ");
  const head = `M${to.map(short).join(" ")}L${barb(1)}L${barb(-1)}Z`;
  return draw("g", { class: "flat-current" },
    draw("line", { x1: from[0], y1: from[1], x2: to[0] - 2.4 * u, y2: to[1] - 2.4 * v }),
    draw("path", { d: head }),
    draw("text", { x: (from[0] + to[0]) / 2, y: Math.max(from[1], to[1]) + 4.5, class: "flat-name" },
      withUnit(water.current_speed_m_s, "m/s", 2)));
}

const short = (metres) => metres.toFixed(2);
