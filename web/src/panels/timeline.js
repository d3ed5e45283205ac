// Time: a slider back through what has been, which can also be played.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { onTheme } from "../theme.js";
import { painted, write } from "./dom.js";
import { day, moment, time } from "./format.js";
import { icon } from "./icons.js";
import { linesOf } from "./journal.js";
import { paintOverview } from "./overview.js";
import { largestOver, marksOf } from "./overview-rows.js";
import { SPANS } from "./past.js";
import { Playback, SPEEDS } from "./playback.js";

const STEPS = 1000; // of the slider
const NEAR = 0.2; // of the span: so near to an end its words make room

export class Timeline {
  constructor(holder, model, past, desk) {
    Object.assign(this, { model, past, desk, marks: [], at: null });
    this.playback = new Playback({ go: (t) => this.go(t), ended: () => this.live() });
    this.liveButton = button("live",
      { className: "live-button", title: text("timeline.liveTitle"), onclick: () => this.live() });
    this.liveButton.append(text("timeline.live"));
    this.playButton = button("play", { className: "round play", onclick: () => this.play() });
    this.speeds = choice(text("timeline.speed"), SPEEDS.map((speed) => [`${speed} ×`, speed]), 600,
      (speed) => { this.playback.speed = speed; });
    this.spans = choice(text("timeline.span"), SPANS, past.spanMs, (spanMs) => past.reach(spanMs));
    this.slider = make("input", { type: "range", className: "time-slider", min: 0, max: STEPS,
      value: STEPS, ariaLabel: text("timeline.slider") });
    this.canvas = make("canvas", { className: "overview", ariaHidden: "true" });
    this.label = make("output", { className: "time-label" });
    const [from, to] = ["from", "to"].map((end) => make("span", { className: `time-${end}` }));
    Object.assign(this, { from, to });
    holder.append(
      make("div", { className: "time-tools" }, this.liveButton, this.playButton, this.speeds),
      make("div", { className: "time-track" }, this.canvas, this.slider,
        make("div", { className: "time-ends" }, from, this.label, to)),
      make("div", { className: "time-span" }, this.spans));
    this.slider.addEventListener("input", () => this.dragged());
    this.paint = painted(() => this.show());
    model.on("topology", () => this.paint());
    model.on("view", ({ mode }) => this.seen(mode));
    model.on("connection", () => this.paint());
    past.on(() => this.paint());
    desk.on(() => this.remark());
    onTheme(() => this.paint());
    new ResizeObserver(() => this.paint()).observe(this.canvas);
    this.paint();
  }

  /** While a time past is awaited no other view comes; so this one ends the travel. */
  seen(mode) {
    if (mode !== "past") {
      this.playback.stop();
      this.at = null;
    }
    this.paint();
  }

  async remark() {
    const lines = await linesOf(this.desk, this.past).catch(() => []);
    this.marks = marksOf(lines, this.desk.alarms);
    this.paint();
  }

  /** Show the cage as it was at a time [ms]. */
  go(t) {
    this.at = t;
    this.model.travel(new Date(t)).catch((error) => {
      this.playback.stop();
      this.model.complain(error);
    });
    this.paint();
  }

  live() {
    this.playback.stop();
    this.at = null;
    this.model.travel(null);
    this.paint();
  }

  dragged() {
    this.playback.stop();
    const place = Number(this.slider.value) / STEPS;
    if (place >= 1) return this.live();
    return this.go(this.past.start + place * this.past.spanMs);
  }

  /** The time past that the reader is at or on the way to [ms]; null in the present. */
  get travelled() {
    const { view } = this.model;
    return this.at ?? (view?.mode === "past" ? view.t : null);
  }

  /** Play from where the reader is; from the begin of the span where that is now. */
  play() {
    if (this.playback.playing) this.playback.stop();
    else if (this.past.end !== undefined) {
      this.playback.start(this.travelled ?? this.past.start, () => this.past.end);
    }
    this.paint();
  }

  /** Go back or on by a fiftieth of the span. */
  step(sign) {
    if (this.past.end === undefined) return;
    const next = Math.max(this.past.start, (this.travelled ?? this.past.end) + (sign * this.past.spanMs) / 50);
    this.playback.stop();
    if (next >= this.past.end) this.live();
    else this.go(next);
  }

  show() {
    const { view, topology } = this.model;
    const there = this.past.end !== undefined;
    for (const one of [this.slider, this.playButton, this.speeds.lastChild]) one.disabled = !there;
    this.mode(view?.mode ?? "live");
    if (!there) return;
    const { start, end, spanMs, columns } = this.past;
    const travels = this.travelled !== null;
    const shown = this.travelled ?? end;
    this.slider.value = Math.round((STEPS * (shown - start)) / spanMs);
    this.slider.setAttribute("aria-valuetext", travels ? moment(shown) : text("timeline.now"));
    this.write((shown - start) / spanMs, travels ? moment(shown) : "", `${day(start)} ${time(start)}`);
    const shares = columns && topology ? largestOver(columns, topology.bridle_capacity_kn, topology.shackles) : [];
    const times = shares.length ? columns.t : [];
    paintOverview(this.canvas, { times, shares, marks: this.marks, start, end,
      gap: topology?.stale_after_s ?? Infinity });
  }

  /** Write each time where it is: the begin, the time travelled to, and now at the end. */
  write(share, travelled, from) {
    write(this.label, travelled);
    this.label.style.left = `${100 * Math.min(1, Math.max(0, share))}%`;
    this.label.dataset.side = share < NEAR ? "left" : share > 1 - NEAR ? "right" : "";
    write(this.from, travelled && share < NEAR ? "" : from);
    const end = this.model.connection === "live" ? text("timeline.now") : moment(this.past.end);
    write(this.to, travelled && share > 1 - NEAR ? "" : end);
  }

  mode(mode) {
    this.liveButton.setAttribute("aria-pressed", mode === "live");
    const { playing } = this.playback;
    if (this.playButton.dataset.playing !== String(playing)) {
      this.playButton.replaceChildren(icon(playing ? "pause" : "play"));
    }
    this.playButton.dataset.playing = playing;
    const action = playing ? text("timeline.pause") : text("timeline.play");
    this.playButton.ariaLabel = action;
    this.playButton.title = text("timeline.withSpace", { action });
  }
}

const button = (shape, properties) => make("button", { type: "button", ...properties }, icon(shape));

function choice(words, options, chosen, pick) {
  const select = make("select", {}, ...options.map(([name, value]) =>
    make("option", { value, selected: value === chosen }, name)));
  select.addEventListener("change", () => pick(Number(select.value)));
  return make("label", { className: "choice" }, make("span", { className: "unseen" }, words), select);
}
