// The alarms as the service has them, and what people do with them.

import { waits } from "./ranks.js";
import { may } from "./rights.js";

const LOOK_MS = 15_000;
const FORBIDDEN = 403;

export class AlarmDesk {
  #listeners = new Set();
  #seen = null;
  #turn = 0;

  constructor(model) {
    this.model = model;
    this.forget();
    model.on("topology", () => this.forget());
    model.on("live", ({ state }) => this.compare(state.alarms ?? []));
    setInterval(() => this.look(), LOOK_MS);
  }

  /** Call `fn` whenever the alarms are other than they were. */
  on(fn) {
    this.#listeners.add(fn);
  }

  forget() {
    const denied = !may(this.model.session?.scopes ?? ["ack"], "ack");
    Object.assign(this, { alarms: null, fault: null, denied });
    this.#seen = null;
    this.#turn += 1; // an answer on its way is of another cage
    this.#tell();
  }

  #tell() {
    for (const fn of this.#listeners) fn();
  }

  /** Ask anew, once, where the live state says that something changed. */
  compare(alarms) {
    const seen = JSON.stringify(alarms.map(({ id, active, acknowledged, shelved, severity }) =>
      [id, active, acknowledged, shelved, severity]));
    if (seen === this.#seen || document.hidden) return;
    this.#seen = seen;
    this.look();
  }

  async look() {
    if (this.model.connection !== "live" || document.hidden) return;
    const turn = ++this.#turn;
    try {
      const { alarms } = await this.model.call("GET", this.path("alarms"));
      if (turn !== this.#turn) return;
      Object.assign(this, { alarms, fault: null });
    } catch (error) {
      if (turn !== this.#turn) return;
      this.fault = error.message;
    }
    this.#tell();
  }

  get waiting() {
    return (this.alarms ?? []).filter(waits);
  }

  /** Do something with an alarm; rejects with a Refusal that says why not. */
  async act(id, action, { why, seconds = null }) {
    try {
      await this.model.call("POST", this.path(`alarms/${encodeURIComponent(id)}/${action}`), { why, seconds });
    } catch (error) {
      this.refused(error);
      throw error;
    }
    await this.look();
  }

  /** Acknowledge alarms of one cause together; what was done stays done where one is refused. */
  async acknowledge(ids, { why }) {
    try {
      for (const id of ids) {
        await this.model.call("POST", this.path(`alarms/${encodeURIComponent(id)}/acknowledge`), { why, seconds: null });
      }
    } catch (error) {
      this.refused(error);
      throw error;
    } finally {
      await this.look();
    }
  }

  /** Remember that this token may not. */
  refused(error) {
    if (error.status !== FORBIDDEN) return;
    this.denied = true;
    this.#tell();
  }

  path(rest) {
    return `cages/${encodeURIComponent(this.model.cageName)}/${rest}`;
  }
}
