// What would be if a line parted: asked of the service when somebody wants to know, not every tick.

import { Observable } from "../observable.js";
import { cagePath } from "../request.js";
import { sentences } from "../service-words.js";
import { text } from "../texts/index.js";

const FRESH_MS = 60_000;
const NOT_FOUND = 404; // a service that does not know the question

/** The newest answer; it calls its listeners when one is asked for and when it has come. */
export class Parting extends Observable {
  #turn = 0;
  #of = null; // what the answer is of: a cage, and a time past or null

  constructor(model) {
    super();
    this.model = model;
    this.forget();
    model.on("topology", () => this.forget());
    model.on("view", (view) => { if (this.#of !== null && this.#of !== this.key(view)) this.forget(); });
  }

  forget() {
    Object.assign(this, { answer: null, fault: "", asking: false, absent: false, cameAt: -Infinity });
    this.#turn += 1;
    this.#of = null;
    this.notify();
  }

  key({ mode, t } = this.model.view ?? {}) {
    return mode === "live" || !mode ? "live" : `${mode} ${t}`;
  }

  /** Ask for what is shown, unless an answer is fresh; no service answers of an imagined sea. */
  async ask({ anew = false } = {}) {
    const { view, cageName } = this.model;
    if (!view || view.mode === "whatif" || this.asking || this.absent) return;
    if (!anew && performance.now() - this.cameAt < FRESH_MS) return;
    const turn = ++this.#turn;
    this.#of = this.key();
    const at = view.mode === "past" ? `?at=${encodeURIComponent(new Date(view.t).toISOString())}` : "";
    this.asking = true;
    this.notify();
    const found = await this.model.call("GET", cagePath(cageName, `what-if-parted${at}`))
      .then((answer) => ({ answer: { ...answer, reason: sentences(answer.reason) }, fault: "" }), (error) => ({ fault: error.message, absent: error.status === NOT_FOUND }));
    if (turn !== this.#turn) return;
    Object.assign(this, { asking: false, cameAt: performance.now() }, found);
    this.notify();
  }

  /** What would be without a line; undefined where that is not known. */
  without(name) {
    return this.answer?.lines?.find(({ parted }) => parted === name);
  }
}

/** Whether a second line would part, in words. */
export const second = ({ second_would_part: would }) =>
  text(`parted.second.${would === null || would === undefined ? "unknown" : would}`);
