// The net, from the side and from above: where it is, against where it hangs in still water.

import { cleared, explain, make, mixed, still, styled } from "./dom.js";
import { bearing, compass, fixed } from "./format.js";

const LEVELS = 10;
const MOVE_MS = 700;
const SLACK_WATER = 0.03; // m/s: below it a direction says nothing, and the view keeps its own
const VIEWS = {
  across: "Across the current",
  south: "From south",
  west: "From west",
};

/** The colour of a line that carries so much of its capacity. */
export function loadColour(utilisation) {
  if (utilisation === null) return styled("--muted");
  if (utilisation >= 1) return styled("--red");
  if (utilisation >= 0.8) return styled("--amber");
  return mixed(styled("--rope-0"), styled("--rope-1"), utilisation / 0.8);
}

export class NetViews {
  constructor({ side, plan, caption, choice, legend }) {
    Object.assign(this, { side, plan, caption, legend, view: "across", angle: 0 });
    this.state = null;
    this.choose(choice);
    new ResizeObserver(() => this.draw()).observe(side);
    new ResizeObserver(() => this.draw()).observe(plan);
    matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => this.draw());
  }

  /** Radio buttons, so that arrow keys move between the views. */
  choose(holder) {
    for (const [name, label] of Object.entries(VIEWS)) {
      const radio = make("input", { type: "radio", name: "view", checked: name === this.view });
      radio.addEventListener("change", () => {
        this.view = name;
        this.move(this.shown);
      });
      holder.append(make("label", {}, radio, make("span", {}, label)));
    }
  }

  /** Take what does not change. */
  topology(topology) {
    this.graph = topology;
    this.rest = Float64Array.from(topology.rest_position_m.flat());
    this.depth = Math.max(...topology.rest_position_m.map(([, , z]) => -z));
    this.reach = Math.max(...topology.rest_position_m.map(([x, y]) => Math.hypot(x, y)));
    this.shown ??= this.rest;
    this.draw();
  }

  /** Take what is now. */
  show({ state, position_mm: position, sigma_mm: sigma }) {
    this.state = state;
    this.sigma = sigma;
    this.move(position ? Float64Array.from(position, (mm) => mm / 1000) : null);
  }

  /** Glide from where the net is drawn to where it is. */
  move(target) {
    cancelAnimationFrame(this.gliding);
    const angle = this.wantedAngle();
    if (!target || still() || !this.moving(target, angle)) {
      this.shown = target ?? this.shown;
      this.angle = angle;
      this.draw();
      return;
    }
    const [from, turned, began] = [this.shown, this.angle, performance.now()];
    const turn = ((((angle - turned) % 360) + 540) % 360) - 180;
    const step = (now) => {
      const part = Math.min(1, Math.max(0, (now - began) / MOVE_MS));
      const eased = 1 - (1 - part) ** 3;
      this.shown = from.map((value, k) => value + (target[k] - value) * eased);
      this.angle = turned + turn * eased;
      this.draw();
      if (part < 1) this.gliding = requestAnimationFrame(step);
    };
    this.gliding = requestAnimationFrame(step);
  }

  moving(target, angle) {
    const changed = target.some((value, k) => Math.abs(value - this.shown[k]) > 0.005);
    return changed || Math.abs(angle - this.angle) > 0.5;
  }

  /** Compass direction that points right in the side view. */
  wantedAngle() {
    if (this.view !== "across") return { south: 90, west: 180 }[this.view];
    const water = this.state?.water;
    return water?.current_speed_m_s > SLACK_WATER ? water.current_to_deg : this.angle;
  }

  draw() {
    if (!this.graph) return;
    this.ink = {
      line: styled("--line"), muted: styled("--muted"), text: styled("--text"),
      ramp: [0, 1, 2].map((k) => styled(`--ramp-${k}`)), accent: styled("--accent"),
      measured: styled("--measured"), card: styled("--card"),
    };
    this.valid = Boolean(this.state?.valid);
    this.lift = this.displacements();
    this.drawSide();
    this.drawPlan();
    this.inWords();
  }

  displacements() {
    const moved = [];
    for (let k = 0; k < this.rest.length; k += 3) {
      const [x, y, z] = [0, 1, 2].map((axis) => this.shown[k + axis] - this.rest[k + axis]);
      moved.push(Math.hypot(x, y, z));
    }
    this.range = [2, 5, 10, 15, 20, 30].find((limit) => limit >= Math.max(...moved)) ?? 40;
    return moved;
  }

  ramp(share) {
    const [a, b, c] = this.ink.ramp;
    return share < 0.5 ? mixed(a, b, share * 2) : mixed(b, c, share * 2 - 1);
  }

  // --- from the side ---

  drawSide() {
    const { context, width, height } = cleared(this.side);
    const [above, below] = [4.5, this.depth + 3];
    // Across the current the net leans to the right: that side gets the room.
    const [left, right] = this.view === "across" ? [1.15, 1.75] : [1.45, 1.45];
    const scale = Math.min(height / (above + below), width / ((left + right) * this.reach));
    const centre = width * (left / (left + right));
    const surface = 0.25 * (height - scale * (above + below)) + above * scale;
    const turn = (this.angle * Math.PI) / 180;
    const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
    // Right along the angle, up is up, and near is what comes out of the screen.
    this.across = (x, y, z) => [
      centre + scale * (x * sin + y * cos), surface - scale * z, x * cos - y * sin,
    ];
    this.water(context, width, height, surface, scale);
    this.net(context, this.rest, this.across, { ghost: true });
    if (this.valid) this.net(context, this.shown, this.across, {});
    this.ropes(context, this.across);
    this.sensors(context, scale);
    this.currentBeside(context, width, surface, scale);
  }

  water(context, width, height, surface, scale) {
    const sea = context.createLinearGradient(0, surface, 0, height);
    sea.addColorStop(0, styled("--sea-0"));
    sea.addColorStop(1, styled("--sea-1"));
    context.fillStyle = sea;
    context.fillRect(0, surface, width, height - surface);
    context.font = `11px ${styled("--font")}`;
    context.textAlign = "right";
    context.lineWidth = 1;
    for (let depth = 0; depth <= this.depth; depth += 10) {
      const y = Math.round(surface + depth * scale) + 0.5;
      context.strokeStyle = depth ? this.ink.line : styled("--surface");
      context.beginPath();
      context.moveTo(0, y);
      context.lineTo(width, y);
      context.stroke();
      context.fillStyle = this.ink.muted;
      context.fillText(depth ? `${depth} m` : "surface", width - 8, y - 4);
    }
  }

  /** Twines, far ones first and fainter, coloured by how far they have moved. */
  net(context, position, project, { ghost = false, flat = false }) {
    const at = (node) => project(...position.subarray(3 * node, 3 * node + 3));
    const points = this.lift.map((_, node) => at(node));
    const groups = new Map();
    for (const [a, b] of this.graph.edges) {
      const near = flat || points[a][2] + points[b][2] > 0;
      const share = (this.lift[a] + this.lift[b]) / 2 / this.range;
      const level = ghost ? 0 : Math.min(LEVELS, Math.round(share * LEVELS));
      const key = (near ? 100 : 0) + level;
      if (!groups.has(key)) groups.set(key, new Path2D());
      groups.get(key).moveTo(points[a][0], points[a][1]);
      groups.get(key).lineTo(points[b][0], points[b][1]);
    }
    for (const key of [...groups.keys()].sort((a, b) => a - b)) {
      const near = key >= 100;
      context.globalAlpha = ghost ? (near ? 0.16 : 0.07) : near ? 0.95 : 0.32;
      context.lineWidth = ghost ? 1 : near ? 1.15 : 0.9;
      context.strokeStyle = ghost ? this.ink.text : this.ramp((key % 100) / LEVELS);
      context.stroke(groups.get(key));
    }
    context.globalAlpha = 1;
    if (!ghost || !this.valid) this.collar(context, points);
  }

  collar(context, points) {
    context.strokeStyle = this.valid ? this.ink.text : this.ink.muted;
    context.lineWidth = 3;
    context.lineJoin = "round";
    context.beginPath();
    points.slice(0, this.graph.spokes).forEach(([x, y], k) =>
      k ? context.lineTo(x, y) : context.moveTo(x, y));
    context.closePath();
    context.stroke();
  }

  ropes(context, project) {
    const { bridle_nodes: nodes, bridle_corners: corners, corner_position_m: frame } = this.graph;
    nodes.forEach((node, k) => {
      const [x, y] = project(...this.shown.subarray(3 * node, 3 * node + 3));
      const [u, v] = project(...frame[corners[k]]);
      context.strokeStyle = loadColour(this.state?.bridles[k].utilisation ?? null);
      context.lineWidth = 2;
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(u, v);
      context.stroke();
    });
  }

  /** Depth sensors where the twin has them; a dash where each says it is. */
  sensors(context, scale) {
    for (const { name, node } of this.graph.depth_sensors) {
      const z = this.shown[3 * node + 2];
      const [x, y] = this.across(...this.shown.subarray(3 * node, 3 * node + 3));
      const read = this.state?.sensors.find((sensor) => sensor.name === name)?.measured ?? null;
      if (read !== null) {
        const measured = y + scale * (z + read);
        context.strokeStyle = this.ink.measured;
        context.lineWidth = 2.5;
        context.beginPath();
        context.moveTo(x - 11, measured);
        context.lineTo(x + 11, measured);
        context.stroke();
      }
      this.mark(context, x, y, name.split("-").at(-1));
    }
  }

  mark(context, x, y, label) {
    context.fillStyle = this.ink.card;
    context.strokeStyle = this.valid ? this.ink.accent : this.ink.muted;
    context.lineWidth = 2;
    context.beginPath();
    context.arc(x, y, 7.5, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    context.fillStyle = this.ink.text;
    context.font = `600 10px ${styled("--font")}`;
    context.textAlign = "center";
    context.fillText(label, x, y + 3.5);
  }

  currentBeside(context, width, surface, scale) {
    const water = this.state?.water;
    if (!this.valid || !(water?.current_speed_m_s > SLACK_WATER)) return;
    const towards = ((water.current_to_deg - this.angle) * Math.PI) / 180;
    const along = Math.cos(towards);
    if (Math.abs(along) < 0.1) return;
    const length = Math.min(0.14 * width, 20 + 90 * water.current_speed_m_s);
    const start = along > 0 ? 56 : width - 16;
    for (const depth of [5, 12.5, 20]) {
      const y = surface + depth * scale;
      arrow(context, start, y, start + length * along, y, styled("--water"));
    }
  }

  // --- from above ---

  drawPlan() {
    const { context, width, height } = cleared(this.plan);
    const frame = this.graph.corner_position_m;
    const reach = Math.max(...frame.flat().map(Math.abs)) + 7;
    const scale = Math.min(width, height) / (2 * reach);
    const project = (x, y) => [width / 2 + scale * x, height / 2 - scale * y, 0];
    context.strokeStyle = this.ink.line;
    context.lineWidth = 1.5;
    context.beginPath();
    frame.forEach(([x, y], k) => {
      const point = project(x, y).slice(0, 2);
      if (k) context.lineTo(...point);
      else context.moveTo(...point);
    });
    context.closePath();
    context.stroke();
    if (this.valid) this.net(context, this.shown, project, { flat: true });
    else this.net(context, this.rest, project, { ghost: true, flat: true });
    this.ropes(context, project);
    this.numbers(context, project);
    this.currentAbove(context, project);
    context.fillStyle = this.ink.muted;
    context.font = `600 11px ${styled("--font")}`;
    context.textAlign = "center";
    context.fillText("N", width / 2, project(0, reach)[1] + 12);
  }

  numbers(context, project) {
    const { bridle_nodes: nodes, bridle_corners: corners, corner_position_m: frame } = this.graph;
    context.font = `11px ${styled("--font")}`;
    context.textAlign = "center";
    context.fillStyle = this.ink.text;
    nodes.forEach((node, k) => {
      const [x, y] = this.shown.subarray(3 * node, 3 * node + 2);
      const [u, v] = frame[corners[k]];
      const [px, py] = project(x + 0.42 * (u - x), y + 0.42 * (v - y));
      context.strokeStyle = this.ink.card;
      context.lineWidth = 4;
      context.strokeText(k + 1, px, py + 4);
      context.fillText(k + 1, px, py + 4);
    });
  }

  currentAbove(context, project) {
    const water = this.state?.water;
    if (!this.valid || !(water?.current_speed_m_s > SLACK_WATER)) return;
    const turn = (water.current_to_deg * Math.PI) / 180;
    const [x, y] = [Math.sin(turn), Math.cos(turn)];
    const half = 7 + 12 * Math.min(1, water.current_speed_m_s);
    const ends = [...project(-half * x, -half * y), ...project(half * x, half * y)];
    arrow(context, ends[0], ends[1], ends[3], ends[4], this.ink.card, 7);
    arrow(context, ends[0], ends[1], ends[3], ends[4], styled("--water"), 2.5);
  }

  // --- in words ---

  inWords() {
    const water = this.state?.water;
    const going = water?.current_speed_m_s > SLACK_WATER
      ? `${fixed(water.current_speed_m_s, 2)} m/s towards ${bearing(water.current_to_deg)} ` +
        compass(water.current_to_deg)
      : "slack water";
    const seen = { across: "Seen across the current", south: "Seen from south, east to the right",
      west: "Seen from west, south to the right" }[this.view];
    const guess = this.state?.in_domain ? "" : ", extrapolated";
    this.caption.textContent = this.valid ? `${seen}: ${going}${guess}` : "The net in still water";
    const bottom = this.lift.at(-1);
    this.side.setAttribute("aria-label", this.valid
      ? `Side view: ${going}; the bottom has moved ${fixed(bottom)} m from rest.`
      : "Side view of the net in still water; there is no valid input.");
    explain(this.legend, {
      ramp: `moved 0 to ${this.range} m from rest`,
      ghost: "still water",
      mark: "depth sensor, by simulation",
      dash: "measured",
    });
  }
}

function arrow(context, x, y, u, v, colour, width = 2) {
  const [length, turn] = [Math.hypot(u - x, v - y), Math.atan2(v - y, u - x)];
  const head = Math.min(7 + 1.5 * width, 0.6 * length);
  context.save();
  context.translate(x, y);
  context.rotate(turn);
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = width;
  context.lineCap = context.lineJoin = "round";
  context.beginPath();
  context.moveTo(0, 0);
  context.lineTo(length - head, 0);
  context.stroke();
  context.beginPath();
  context.moveTo(length, 0);
  context.lineTo(length - head, 0.5 * head);
  context.lineTo(length - head, -0.5 * head);
  context.closePath();
  context.fill();
  context.lineWidth = 0.6 * width;
  context.stroke();
  context.restore();
}
