// What has been, for all panels that look back: one span, one message of the service.

import { append, columnsOf, trim } from "./columns.js";

export const HOUR_MS = 3600e3;
export const SPANS = [
  ["1 h", HOUR_MS], ["6 h", 6 * HOUR_MS], ["24 h", 24 * HOUR_MS], ["3 days", 72 * HOUR_MS],
  ["7 days", 168 * HOUR_MS], ["30 days", 720 * HOUR_MS],
];
const POINTS = 2000; // of a curve: more than a screen has columns
const MISSED_MS = 0.5 * HOUR_MS; // a longer step of the clock means that something was missed
const AGAIN_MS = 10_000; // of the wall: a fast replay misses all the time

export class Past {
  #listeners = new Set();
  #requests = 0;
  #askedAt = -Infinity;

  constructor(model) {
    this.model = model;
    this.spanMs = 24 * HOUR_MS;
    this.columns = null;
    this.fault = null;
    model.on("topology", () => this.forget());
    model.on("live", (live) => this.take(live));
  }

  /** Call `fn` whenever there is more, or other, past. */
  on(fn) {
    this.#listeners.add(fn);
  }

  #tell() {
    for (const fn of this.#listeners) fn();
  }

  forget() {
    Object.assign(this, { columns: null, fault: null, end: undefined });
    this.#requests += 1;
    this.#askedAt = -Infinity;
    this.#tell();
  }

  /** The span that is looked back over, up to now [ms]. */
  get start() {
    return this.end - this.spanMs;
  }

  /** Look further back, or less far. */
  reach(spanMs) {
    this.spanMs = spanMs;
    this.#tell();
    if (this.end !== undefined) this.load();
  }

  take({ t, state }) {
    const step = t - (this.end ?? t);
    const missed = !this.columns || step < 0 || step > MISSED_MS;
    this.end = t;
    if (missed && performance.now() - this.#askedAt > AGAIN_MS) this.load();
    if (this.columns) {
      append(this.columns, state, this.spanMs / 1000 / POINTS);
      trim(this.columns, this.start / 1000);
    }
    this.#tell();
  }

  /** Ask the service for the span anew. */
  async load() {
    const turn = ++this.#requests;
    this.#askedAt = performance.now();
    const from = encodeURIComponent(new Date(this.start).toISOString());
    const path = `cages/${encodeURIComponent(this.model.cageName)}/history`;
    try {
      const history = await this.model.call("GET", `${path}?from=${from}&limit=${POINTS}`);
      if (turn !== this.#requests) return;
      Object.assign(this, { columns: columnsOf(history), fault: null });
    } catch (error) {
      if (turn !== this.#requests) return;
      this.fault = error.message;
    }
    this.#tell();
  }
}
