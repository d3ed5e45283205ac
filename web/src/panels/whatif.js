// What if: another sea, and what the net and the loads would do in it.

import { make } from "../dom.js";
import { largestPredicted } from "../known-load.js";
import { cagePath } from "../request.js";
import { text } from "../texts/index.js";
import { onUnits } from "../units.js";
import { dial } from "./dial.js";
import { tableHead, write } from "./dom.js";
import { bearing, beyond, compass, known, titled, withUnit } from "./format.js";
import { icon } from "./icons.js";
import { change, choices, introduced, learnedWords, seaNow } from "./sea-wanted.js";

export class WhatIf {
  constructor(holder, model) {
    this.model = model;
    this.aside = make("p", { className: "aside" });
    this.inputs = make("div", { className: "whatif-sea" });
    this.warning = make("p", { className: "beyond-note", role: "status", hidden: true });
    this.fault = make("p", { className: "dialog-fault", role: "alert", hidden: true });
    this.table = make("tbody");
    this.back = make("button", { type: "button", className: "button main", disabled: true,
      onclick: () => model.travel(null) }, text("whatif.back"));
    this.anew = make("button", { type: "button", className: "button", disabled: true,
      onclick: () => this.reset() }, text("whatif.anew"));
    holder.append(this.aside, this.inputs, this.fault, this.warning,
      make("table", { className: "compared" },
        make("caption", { className: "unseen" }, text("whatif.caption")),
        tableHead(["what", "now", "then", "change"].map((head) => text(`whatif.heads.${head}`))), this.table),
      make("div", { className: "whatif-buttons" }, this.back, this.anew));
    for (const name of ["view", "live"]) model.on(name, () => this.show());
    model.on("topology", () => this.learn());
    onUnits(() => this.fill());
    this.forget();
  }

  forget() {
    Object.assign(this, { kinds: [], shows: [], sea: {}, begun: false });
    this.inputs.replaceChildren();
    this.anew.disabled = true;
    write(this.aside, text("whatif.asking"));
    this.fill();
  }

  /** Ask what the twin has learned, and offer that alone. */
  async learn() {
    this.forget();
    const { cageName } = this.model;
    try {
      const learned = await this.model.call("GET", cagePath(cageName, "whatif"));
      if (cageName !== this.model.cageName) return;
      this.offer(learned);
      this.say("");
    } catch (error) {
      this.say(error.message);
    }
  }

  offer(learned) {
    this.kinds = choices(learned);
    write(this.aside, introduced(learned));
    this.shows = [];
    this.inputs.replaceChildren(...this.kinds.map(({ speed, way }) =>
      make("div", { className: "whatif-kind" }, this.slider(speed), this.dial(way))));
    this.anew.disabled = false;
    this.sea = seaNow(this.kinds, this.model.live?.state.water);
    this.fill();
  }

  dial({ key, name, kind }) {
    const { box, show } = dial({ name, kind, says: (d) => `${bearing(d)} ${compass(d)}`,
      turn: (degrees) => this.take({ [key]: degrees }) });
    this.shows.push(() => show(this.sea[key]));
    return box;
  }

  slider({ key, name, unit, least, most, step, decimals, learned }) {
    const input = make("input", { type: "range", min: least, max: most, step, id: `whatif-${key}` });
    const words = make("output", { className: "slider-words", htmlFor: input.id });
    input.addEventListener("input", () => this.take({ [key]: Number(input.value) }));
    const learnedNote = make("small");
    this.shows.push(() => {
      write(learnedNote, learnedWords({ learned, unit, decimals }));
      input.value = this.sea[key];
      const shown = withUnit(this.sea[key], unit, decimals);
      input.setAttribute("aria-valuetext", shown);
      write(words, shown);
    });
    return make("div", { className: "slider" }, make("label", { htmlFor: input.id }, name), words, input,
      learnedNote);
  }

  /** Change the sea and ask what it does; the model keeps only the newest question. */
  async take(changed) {
    this.sea = { ...this.sea, ...changed };
    this.begun = true;
    this.fill();
    const query = this.sea;
    try {
      await this.model.whatIf(query);
      this.say("");
    } catch (error) {
      if (query === this.sea) this.say(error.message);
    }
  }

  say(fault) {
    this.fault.hidden = !fault;
    write(this.fault, fault);
  }

  reset() {
    this.take(seaNow(this.kinds, this.model.live?.state.water));
  }

  /** Begin with the sea of now, until the reader has moved something. */
  visible(shown) {
    if (!shown || this.begun) return;
    this.sea = seaNow(this.kinds, this.model.live?.state.water);
    this.fill();
  }

  fill() {
    for (const show of this.shows) show();
    this.show();
  }

  show() {
    const { view, live } = this.model;
    const then = view?.mode === "whatif" ? view.state : null;
    this.back.disabled = !then;
    this.warning.hidden = !then || (then.valid && then.in_domain);
    if (!this.warning.hidden) {
      const why = then.valid ? text("whatif.extrapolating", { reason: beyond(then.reason) })
        : text("whatif.noAnswer", { reason: then.reason });
      if (this.warning.textContent !== why) this.warning.replaceChildren(icon("beyond"), why);
    }
    this.table.replaceChildren(...compared(live?.state, then));
  }
}

function compared(now, then) {
  const load = [largestPredicted(now), largestPredicted(then)];
  const share = (state) => (state?.valid && known(state.volume_fraction) ? 100 * state.volume_fraction : NaN);
  const least = (state) => (state?.valid ? Math.min(...depths(state)) : NaN);
  return [
    row(text("whatif.load"), load.map((one) => one?.kn), "kN", 1),
    row(text("whatif.share"), load.map((one) => 100 * (one?.share ?? NaN)), "%", 0,
      load.map((one) => (one ? titled(one.name) : ""))),
    ...([now, then].some((state) => state?.lines?.length)
      ? [row(text("whatif.maximum"), [now, then].map(largestInWaves), "kN", 1)] : []),
    row(text("whatif.volume"), [share(now), share(then)], "%", 1),
    row(text("whatif.shallowest"), [least(now), least(then)], "m", 1),
  ];
}

/** The largest tension that any bridle is expected to bear in three hours of a sea. */
function largestInWaves(state) {
  const bridles = (state?.lines ?? []).filter(({ kind }) => kind === "bridle");
  const found = bridles.map(({ maximum_3h_kn: largest }) => largest.mean).filter(known);
  return found.length ? Math.max(...found) : NaN;
}

const depths = ({ sensors }) => sensors.filter(({ unit }) => unit === "m").map(({ mean }) => mean);

function row(name, [now, then], unit, decimals, notes = []) {
  const cell = (value, note) => make("td", { className: "number" },
    withUnit(value, unit, decimals),
    note ? make("small", {}, ` ${note}`) : "");
  return make("tr", {}, make("th", { scope: "row" }, name), cell(now, notes[0]), cell(then, notes[1]),
    make("td", { className: "number change" }, change(now, then, unit, decimals)));
}
