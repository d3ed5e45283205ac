// What has been, for all panels that look back: one span, one message of the service.

import { Observable } from "../observable.js";
import { cagePath } from "../request.js";
import { text } from "../texts/index.js";
import { append, columnsOf, trim } from "./columns.js";

const HOUR_MS = 3600e3;
export const SPANS = [
  ...[1, 6, 24].map((count) => [text("span.hours", { count }), count * HOUR_MS]),
  ...[3, 7, 30].map((count) => [text("span.days", { count }), 24 * count * HOUR_MS]),
];
const POINTS = 2000; // of a curve: more than a screen has columns
const MISSED_MS = 0.5 * HOUR_MS; // a longer step of the clock means that something was missed
const AGAIN_MS = 10_000; // of the wall: a fast replay misses all the time

/** The past of the cage; it calls its listeners whenever there is more, or another. */
export class Past extends Observable {
  #requests = 0;
  #requestedAt = -Infinity;

  constructor(model) {
    super();
    this.model = model;
    this.spanMs = 24 * HOUR_MS;
    this.columns = null;
    this.fault = null;
    model.on("topology", () => this.forget());
    model.on("live", (live) => this.take(live));
  }

  forget() {
    Object.assign(this, { columns: null, fault: null, end: undefined });
    this.#requests += 1;
    this.#requestedAt = -Infinity;
    this.notify();
  }

  /** The span that is looked back over, up to now [ms]. */
  get start() {
    return this.end - this.spanMs;
  }

  /** The span in the query of a request; its end, of a millisecond, is in it. */
  get query() {
    const [from, to] = [this.start, this.end + 1].map((t) => new Date(t).toISOString());
    return new URLSearchParams({ from, to });
  }

  /** Look further back, or less far. */
  reach(spanMs) {
    this.spanMs = spanMs;
    this.notify();
    if (this.end !== undefined) this.load();
  }

  take({ t, state }) {
    const step = t - (this.end ?? t);
    const missed = !this.columns || step < 0 || step > MISSED_MS;
    this.end = t;
    if (missed && performance.now() - this.#requestedAt > AGAIN_MS) this.load();
    if (this.columns) {
      append(this.columns, state, this.spanMs / 1000 / POINTS);
      trim(this.columns, this.start / 1000);
    }
    this.notify();
  }

  /** Ask the service for the span anew. */
  async load() {
    const turn = ++this.#requests;
    this.#requestedAt = performance.now();
    const from = encodeURIComponent(new Date(this.start).toISOString());
    try {
      const history = await this.model.call("GET",
        cagePath(this.model.cageName, `history?from=${from}&limit=${POINTS}`));
      if (turn !== this.#requests) return;
      Object.assign(this, { columns: columnsOf(history), fault: null });
    } catch (error) {
      if (turn !== this.#requests) return;
      this.fault = error.message;
    }
    this.notify();
  }
}
