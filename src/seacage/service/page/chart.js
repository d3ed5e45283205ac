// A small chart over time: simulation alone, the twin with its interval, and what was measured.

import { cleared, styled } from "./dom.js";
import { fixed, ticks, time } from "./format.js";

const EDGE = { left: 34, right: 8, top: 8, bottom: 18 };
const HOUR = 3600e3;
const GAP = 3 * HOUR;

export class Chart {
  /** `read` is told the point under the reader's pointer or arrow keys, or null. */
  constructor(canvas, { downwards, read }) {
    Object.assign(this, { canvas, downwards, read, cursor: null });
    canvas.tabIndex = 0;
    canvas.addEventListener("pointermove", ({ offsetX }) => this.point(this.timeAt(offsetX)));
    canvas.addEventListener("pointerleave", () => this.point(null));
    canvas.addEventListener("blur", () => this.point(null));
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia("(prefers-color-scheme: light)").addEventListener("change", () => this.draw());
  }

  /** `twin` and `measured` are in time order: {t, low, mean, lower, upper} and {t, value}. */
  show({ twin, measured, start, end }) {
    Object.assign(this, { twin, measured, start, end });
    this.draw();
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step || !this.twin?.length) return;
    event.preventDefault();
    const at = this.twin.findIndex(({ t }) => t === this.cursor);
    const next = at < 0 ? this.twin.length - 1 : at + step;
    this.point(this.twin[Math.min(this.twin.length - 1, Math.max(0, next))].t);
  }

  timeAt(x) {
    const width = this.canvas.clientWidth - EDGE.left - EDGE.right;
    return this.start + ((x - EDGE.left) / width) * (this.end - this.start);
  }

  point(t) {
    if (!this.twin) return;
    const near = t === null ? null : nearest(this.twin, t);
    this.cursor = near?.t ?? null;
    const found = near && nearest(this.measured, near.t);
    const fits = found && Math.abs(found.t - near.t) < HOUR / 2;
    this.read(near && { ...near, measured: fits ? found.value : null });
    this.draw();
  }

  range() {
    const seen = [
      ...this.twin.flatMap(({ low, lower, upper }) => [low, lower, upper]),
      ...this.measured.map(({ value }) => value),
    ].filter(Number.isFinite);
    if (!seen.length) return [0, 1];
    const [low, high] = [Math.min(...seen), Math.max(...seen)];
    const margin = Math.max(0.08 * (high - low), 0.02 * Math.abs(high), 0.05);
    return [low - margin, high + margin];
  }

  draw() {
    const { context, width, height } = cleared(this.canvas);
    if (!this.twin || width < 80) return;
    const [low, high] = this.range();
    const [x0, x1] = [EDGE.left, width - EDGE.right];
    const [y0, y1] = [EDGE.top, height - EDGE.bottom];
    this.x = (t) => x0 + ((t - this.start) / (this.end - this.start)) * (x1 - x0);
    const share = (value) => (value - low) / (high - low);
    this.y = (value) => y0 + (this.downwards ? share(value) : 1 - share(value)) * (y1 - y0);
    this.grid(context, low, high, x0, x1, y1);
    context.save();
    context.beginPath();
    context.rect(x0, 0, x1 - x0, y1 + 4);
    context.clip();
    this.curves(context);
    context.restore();
  }

  grid(context, low, high, x0, x1, y1) {
    context.font = `11px ${styled("--font")}`;
    context.fillStyle = styled("--muted");
    context.strokeStyle = styled("--line");
    context.lineWidth = 1;
    const { marks, decimals } = ticks(low, high, 4);
    context.textAlign = "right";
    for (const mark of marks) {
      const y = Math.round(this.y(mark)) + 0.5;
      line(context, x0, y, x1, y);
      context.fillText(fixed(mark, decimals), x0 - 6, y + 3.5);
    }
    context.textAlign = "center";
    const every = Math.max(6 * HOUR, Math.ceil((this.end - this.start) / (4 * HOUR)) * HOUR);
    for (let t = Math.ceil(this.start / every) * every; t < this.end; t += every) {
      if (this.x(t) > x0 + 10 && this.x(t) < x1 - 12) context.fillText(time(t), this.x(t), y1 + 14);
    }
  }

  curves(context) {
    context.lineJoin = "round";
    for (const part of pieces(this.twin)) {
      context.fillStyle = styled("--band");
      context.beginPath();
      part.forEach(({ t, upper }) => context.lineTo(this.x(t), this.y(upper)));
      [...part].reverse().forEach(({ t, lower }) => context.lineTo(this.x(t), this.y(lower)));
      context.fill();
      this.curve(context, part, "low", styled("--low"), [4, 3], 1.4);
    }
    context.fillStyle = styled("--measured");
    for (const { t, value } of this.measured) {
      context.fillRect(this.x(t) - 1, this.y(value) - 1, 2, 2);
    }
    for (const part of pieces(this.twin)) {
      this.curve(context, part, "mean", styled("--accent"), [], 1.8);
    }
    if (this.cursor !== null) {
      context.strokeStyle = styled("--muted");
      context.lineWidth = 1;
      line(context, this.x(this.cursor), 0, this.x(this.cursor), context.canvas.height);
    }
  }

  curve(context, part, name, colour, dash, width) {
    context.setLineDash(dash);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    part.forEach((point) => context.lineTo(this.x(point.t), this.y(point[name])));
    context.stroke();
    context.setLineDash([]);
  }
}

/** Stretches of a curve without a gap: an unknown value is not drawn through. */
function pieces(points) {
  const parts = [[]];
  for (const point of points) {
    const last = parts.at(-1).at(-1);
    if (point.mean === null || (last && point.t - last.t > GAP)) parts.push([]);
    if (point.mean !== null) parts.at(-1).push(point);
  }
  return parts.filter((part) => part.length);
}

function nearest(points, t) {
  let best = null;
  for (const point of points) {
    if (!best || Math.abs(point.t - t) < Math.abs(best.t - t)) best = point;
  }
  return best;
}

function line(context, x, y, u, v) {
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(u, v);
  context.stroke();
}
