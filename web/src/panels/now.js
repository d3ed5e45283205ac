// The sea and the cage now, in four numbers.

import { make } from "../dom.js";
import { write } from "./dom.js";
import { DASH, bearing, compass, fixed, half, known, percent, plain } from "./format.js";
import { intervalOf } from "./load-rows.js";
import { waterArrow } from "./water-arrow.js";

export class Now {
  constructor(holder, model) {
    this.model = model;
    this.current = figure("Current", waterArrow("current"));
    this.waves = figure("Waves", waterArrow("wave"));
    this.load = figure("Largest load");
    this.volume = figure("Cage volume");
    this.why = make("p", { className: "now-why", hidden: true });
    holder.append(
      make("h2", { className: "unseen" }, "Now"),
      make("dl", { className: "figures" },
        ...[this.current, this.waves, this.load, this.volume].map(({ box }) => box)),
      this.why);
    model.on("view", () => this.show());
    this.show();
  }

  show() {
    const state = this.model.view?.state;
    const water = state?.valid ? state.water : null;
    this.current.say(fixed(water?.current_speed_m_s, 2), "m/s",
      towards("towards", water?.current_to_deg));
    this.current.turn(water?.current_to_deg);
    this.sayWaves(water);
    const top = highest(state);
    this.load.say(fixed(top?.tension_kn.mean), `${half(intervalOf(top))} kN`, top
      ? `${plain(top.name)}, ${percent(top.utilisation)} of capacity${top.level > 1 ? "" : ", simulated"}` : "");
    const share = state?.valid ? state.volume_fraction : null;
    this.volume.say(known(share) ? String(Math.round(100 * share)) : DASH, "%",
      known(share) ? "of that in still water" : "");
    this.explain(state);
  }

  sayWaves(water) {
    const period = known(water?.tp_s) ? `${fixed(water.tp_s)} s, ` : "";
    this.waves.say(fixed(water?.hs_m), "m",
      known(water?.hs_m) ? `${period}${towards("from", water.wave_from_deg)}` : water ? "not known" : "");
    this.waves.turn(known(water?.wave_from_deg) ? water.wave_from_deg + 180 : null);
  }

  /** Say why there are no numbers: a dash alone leaves its reader to guess. */
  explain(state) {
    const silent = state?.silent ?? [];
    const words = !state ? ""
      : !state.valid ? `${state.reason || "No usable reading yet."} Numbers come back with the next good reading.`
      : silent.length ? `Silent: ${silent.join(", ")}. The answer does without.` : "";
    this.why.hidden = !words;
    write(this.why, words);
  }
}

/** The bridle nearest its capacity; null without valid input. */
export function highest(state) {
  const loaded = state?.valid ? state.bridles.filter(({ utilisation }) => known(utilisation)) : [];
  return loaded.length ? loaded.reduce((a, b) => (b.utilisation > a.utilisation ? b : a)) : null;
}

function towards(word, degrees) {
  return known(degrees) ? `${word} ${bearing(degrees)} ${compass(degrees)}` : "";
}

function figure(name, pointer) {
  const [value, unit, note] = ["value", "unit", "note"].map((c) => make("span", { className: c }));
  const box = make("div", { className: "figure" }, make("dt", {}, name),
    make("dd", {}, make("span", { className: "figure-line" }, ...(pointer ? [pointer.arrow] : []), value, unit), note));
  const say = (number, its, words) => {
    write(value, number);
    write(unit, number === DASH ? "" : its);
    write(note, words);
  };
  return { box, say, turn: (degrees) => pointer.turn(degrees) };
}
