// The alarms as the service has them, and what people do with them.

import { Observable } from "../observable.js";
import { cagePath } from "../request.js";
import { alarmIn } from "../service-words.js";
import { waits } from "./ranks.js";
import { may } from "./rights.js";

const LOOK_MS = 15_000;
const FORBIDDEN = 403;

/** The alarms of the cage; it calls its listeners whenever they differ. */
export class AlarmDesk extends Observable {
  #seen = null;
  #turn = 0;

  constructor(model) {
    super();
    this.model = model;
    this.forget();
    model.on("topology", () => this.forget());
    model.on("live", ({ state }) => this.compare(state.alarms ?? []));
    setInterval(() => this.look(), LOOK_MS);
  }

  forget() {
    const denied = !may(this.model.session?.scopes ?? ["ack"], "ack");
    Object.assign(this, { alarms: null, fault: null, denied });
    this.#seen = null;
    this.#turn += 1; // an answer on its way is of another cage
    this.notify();
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
      Object.assign(this, { alarms: alarms.map(alarmIn), fault: null });
    } catch (error) {
      if (turn !== this.#turn) return;
      this.fault = error.message;
    }
    this.notify();
  }

  get waiting() {
    return (this.alarms ?? []).filter(waits);
  }

  /** Do something with an alarm; rejects with a Refusal that says why not. */
  async act(id, action, { why, seconds = null }) {
    await this.#post(id, action, { why, seconds });
    await this.look();
  }

  /** Acknowledge alarms of one cause together; what was done stays done where one is refused. */
  async acknowledge(ids, { why }) {
    try {
      for (const id of ids) await this.#post(id, "acknowledge", { why, seconds: null });
    } finally {
      await this.look();
    }
  }

  /** Write down work on the cage; rejects with a Refusal that says why not. */
  async record(change) {
    await this.#send("journal", change);
    this.notify();
  }

  #post(id, action, body) {
    return this.#send(`alarms/${encodeURIComponent(id)}/${action}`, body);
  }

  /** Send what a person does; remember where this token may not. */
  async #send(path, body) {
    try {
      await this.model.call("POST", this.path(path), body);
    } catch (error) {
      if (error.status === FORBIDDEN) {
        this.denied = true;
        this.notify();
      }
      throw error;
    }
  }

  path(rest) {
    return cagePath(this.model.cageName, rest);
  }
}
