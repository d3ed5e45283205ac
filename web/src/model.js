// What the page knows: the one place that the scene and the panels read and ask.

import { possible } from "./bounds.js";
import { latestOnly } from "./latest.js";
import { connect } from "./link.js";
import { cagePath, Refusal } from "./request.js";
import { cageIn, stateIn } from "./service-words.js";
import { begin, call, forget, renewal, resume, signIn, signOut } from "./session.js";
import { text } from "./texts/index.js";
import { readFrame } from "./wire.js";

const LOOK_ROUND_MS = 10_000;
const STALE_UNKNOWN_S = 3600;

/**
 * The page's model.
 *
 * Names to listen to: `connection`, `topology`, `view` (what is shown), `live` (what is so now,
 * whatever is shown), `cages`, `session` (who is signed in), `selection`, `age` (each second),
 * `trouble` (an Error to show).
 */
export class Model {
  /** "connecting" | "live" | "lost" | "refused" | "asking" */
  connection = "connecting";
  /** Why, in a sentence, where the connection is not live. */
  why = "";
  /** Of the cage, as the service sent it, with `rest` (Float32Array). */
  topology = null;
  /** What is shown; null until the first frame. */
  view = null;
  /** What is so now; the same object as `view` in live mode. */
  live = null;
  cages = [];
  cageName = null;
  /** {bridle: name} | {line: name} of any other | {node: index} | {sensor: name} | null */
  selection = null;

  #listeners = new Map();
  #link = null;
  #wanted = null; // what the reader chose: a Date, an input of a what-if, or null for live
  #frameOfPast = latestOnly((at) =>
    this.call("GET", cagePath(this.cageName, `frame?at=${encodeURIComponent(at.toISOString())}`)));
  #frameOfWhatIf = latestOnly((input) => this.call("POST", cagePath(this.cageName, "whatif"), input));

  /** Call `fn` with what changed, from now on; the answer stops it. */
  on(name, fn) {
    const all = this.#listeners.get(name) ?? new Set();
    this.#listeners.set(name, all.add(fn));
    return () => all.delete(fn);
  }

  #notify(name, value) {
    for (const fn of this.#listeners.get(name) ?? []) fn(value);
  }

  /** Begin: as who is signed in, or with a token. */
  async open(given = null) {
    this.#connected("connecting");
    try {
      this.session = await (given === null ? begin() : signIn(given));
    } catch (error) {
      return this.#notBegun(error);
    }
    this.#notify("session", this.session);
    try {
      await this.#lookRound();
    } catch (error) {
      if (error.status === 401) return this.#askForToken(text("session.cookie"));
      return this.#notBegun(error);
    }
    this.#repeat();
    const wanted = new URLSearchParams(location.search).get("cage");
    const names = this.cages.map(({ name }) => name);
    return this.cage(names.includes(wanted) ? wanted : names[0]);
  }

  #notBegun(error) {
    if (error.status >= 400 && error.status < 500) return this.#askForToken(error.message);
    this.#connected("lost", text("connection.again"));
    return setTimeout(() => this.open(), 3000);
  }

  /** Look round, count the seconds and stay signed in, for as long as the page is open. */
  #repeat() {
    this.#rest();
    this.round = setInterval(() => this.#lookRound().catch(() => {}), LOOK_ROUND_MS);
    this.second = setInterval(() => this.#notify("age", this.view), 1000);
    this.renewed = setInterval(() => resume().catch(() => {}), renewal());
  }

  #rest() {
    for (const one of [this.round, this.second, this.renewed]) clearInterval(one);
  }

  async #lookRound() {
    if (document.hidden && this.cages.length) return;
    this.cages = (await call("GET", "cages")).cages.map(cageIn);
    this.#notify("cages", this.cages);
  }

  /** Use a token that the reader typed. */
  enter(given) {
    return this.open(given);
  }

  /** Sign out, and leave nothing of the cage on the page. Rejects with a Refusal. */
  async leave() {
    await signOut();
    location.reload();
  }

  /** Show another cage. */
  cage(name) {
    this.#link?.close();
    Object.assign(this, { cageName: name, view: null, live: null, topology: null });
    this.#wanted = null;
    this.select(null);
    const search = new URLSearchParams(location.search);
    if (this.cages.length > 1) search.set("cage", name);
    history.replaceState(null, "", `${location.pathname}${search.size ? `?${search}` : ""}`);
    this.#connected("connecting");
    this.#link = connect(name, {
      topology: (message) => this.#setTopology(message),
      frame: (buffer) => this.#setLive(buffer),
      lost: (seconds) => this.#connected("lost", text("connection.retry", { seconds })),
      refused: (why) => this.#refused(why),
    });
  }

  /** Try to connect at once. */
  retry() {
    if (this.#link) this.#link.again();
    else this.open();
  }

  #setTopology(message) {
    if (message.topology_id && message.topology_id === this.topology?.topology_id) return;
    this.topology = { ...message, rest: Float32Array.from(message.rest_position_m.flat()) };
    this.#notify("topology", this.topology);
  }

  #setLive(buffer) {
    try {
      this.live = this.#viewOf(buffer, "live");
    } catch (error) {
      // Another version of the service: the next frame would be no better.
      this.#link.close();
      return this.#connected("refused", error.message);
    }
    if (this.connection !== "live") this.#connected("live");
    this.#notify("live", this.live);
    if (this.#wanted === null) this.#show(this.live);
    return undefined;
  }

  #viewOf(buffer, mode) {
    const frame = readFrame(buffer, this.topology.rest);
    return viewOf(frame, mode, {
      staleAfterS: this.topology.stale_after_s,
      speed: mode === "live" ? this.topology.speed : 0,
      isLost: () => this.connection !== "live",
    });
  }

  #show(view) {
    this.view = view;
    this.#notify("view", view);
  }

  /** Let everybody show anew what is known, as in other units. */
  refresh() {
    if (this.view) this.#notify("view", this.view);
    if (this.live) this.#notify("live", this.live);
    if (this.cages.length) this.#notify("cages", this.cages);
  }

  /** Show the cage at a time past; null goes back to now. Rejects with a Refusal. */
  travel(date) {
    return this.#go(date, "past", this.#frameOfPast);
  }

  /** Show what would be in another sea; null goes back to now. Rejects with a Refusal. */
  whatIf(input) {
    return this.#go(input, "whatif", this.#frameOfWhatIf);
  }

  async #go(wanted, mode, ask) {
    this.#wanted = wanted;
    if (wanted === null) {
      if (this.live) this.#show(this.live);
      return;
    }
    const buffer = await ask(wanted);
    // Overtaken by another wish, or by another cage.
    if (!buffer || this.#wanted !== wanted || !this.topology) return;
    this.#show(this.#viewOf(buffer, mode));
  }

  /** Point at a line, node or sensor, in every part of the page; null at none. */
  select(selection) {
    if (JSON.stringify(selection) === JSON.stringify(this.selection)) return;
    this.selection = selection;
    this.#notify("selection", selection);
  }

  /** Call the service: a path under /api/v1, such as `cages/ace/alarms`. Rejects with a Refusal. */
  async call(method, path, body) {
    try {
      return await call(method, path.replace(/^\//, ""), body);
    } catch (error) {
      if (error instanceof Refusal && error.status === 401) this.#askForToken(text("session.ended"));
      throw error;
    }
  }

  /** Show the reader that something did not work. */
  complain(error) {
    this.#notify("trouble", error);
  }

  #connected(connection, why = "") {
    Object.assign(this, { connection, why });
    this.#notify("connection", connection);
  }

  #refused(why) {
    if (why === "unknown") return this.#askForToken(text("session.ended"));
    this.#part();
    return this.#connected("refused", why === "cage" ? text("connection.noCage") : text("connection.noScope"));
  }

  /** Ask the reader for a token. */
  #askForToken(why) {
    this.#part();
    forget();
    return this.#connected("asking", why);
  }

  /** Ask the service for nothing more. */
  #part() {
    this.#rest();
    this.#link?.close();
    this.#link = null;
  }
}

/** A frame with what the page adds: how it came about, and how old its input is by now. */
export function viewOf(frame, mode, { staleAfterS = STALE_UNKNOWN_S, speed, isLost }) {
  const came = performance.now();
  return {
    ...frame,
    state: stateIn(possible(frame.state)),
    mode,
    /** Age of the input [s]; null where there is none. */
    get ageS() {
      const { age_s: age } = frame.state;
      return age === null ? null : age + (speed * (performance.now() - came)) / 1000;
    },
    /** Whether what is shown is too old to trust as now. */
    get stale() {
      if (mode !== "live") return false;
      return isLost() || (this.ageS !== null && this.ageS > staleAfterS);
    },
  };
}
