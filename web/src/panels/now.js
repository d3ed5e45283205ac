// The sea and the cage now, in four numbers.

import { make } from "../dom.js";
import { largestKnown } from "../known-load.js";
import { text } from "../texts/index.js";
import { unitName } from "../units.js";
import { write } from "./dom.js";
import { DASH, amount, bearing, compass, half, known, percent, plain, withUnit } from "./format.js";
import { intervalOf } from "./load-rows.js";
import { waterArrow } from "./water-arrow.js";

export class Now {
  constructor(holder, model) {
    this.model = model;
    this.current = figure("current", waterArrow("current"));
    this.waves = figure("waves", waterArrow("wave"));
    this.load = figure("load");
    this.volume = figure("volume");
    this.why = make("p", { className: "now-why", hidden: true });
    holder.append(
      make("h2", { className: "unseen" }, text("now.title")),
      make("dl", { className: "figures" },
        ...[this.current, this.waves, this.load, this.volume].map(({ box }) => box)),
      this.why);
    model.on("view", () => this.show());
    this.show();
  }

  show() {
    const state = this.model.view?.state;
    const water = state?.valid ? state.water : null;
    this.current.say(amount(water?.current_speed_m_s, "m/s", 2), unitName("m/s"),
      known(water?.current_to_deg) ? text("now.towards", { direction: way(water.current_to_deg) }) : "");
    this.current.turn(water?.current_to_deg);
    this.sayWaves(water);
    const top = largestKnown(state);
    const interval = top && !top.by ? intervalOf(top.bridle) : null;
    this.load.say(amount(top?.kn, "kN"), `${half(interval, "kN")} ${unitName("kN")}`, top ? loadWords(top) : "");
    this.load.mark(concernOf(state, "load"));
    const share = state?.valid ? state.volume_fraction : null;
    const [lower, mean, upper] = ["_lower", "", "_upper"].map((end) => 100 * (state?.[`volume_fraction${end}`] ?? NaN));
    this.volume.say(known(share) ? String(Math.round(100 * share)) : DASH, `${half({ mean, lower, upper }, "%", 0)} %`,
      known(share) ? text("now.ofStill") : "");
    this.volume.mark(concernOf(state, "volume"));
    this.explain(state);
  }

  sayWaves(water) {
    const words = [
      known(water?.tp_s) && withUnit(water.tp_s, "s"),
      known(water?.wave_from_deg) && text("now.from", { direction: way(water.wave_from_deg) }),
    ].filter(Boolean).join(", ");
    this.waves.say(amount(water?.hs_m, "m"), unitName("m"), known(water?.hs_m) ? words : water ? text("number.notKnown") : "");
    this.waves.turn(known(water?.wave_from_deg) ? water.wave_from_deg + 180 : null);
  }

  /** Say why there are no numbers: a dash alone leaves its reader to guess. */
  explain(state) {
    const silent = state?.silent ?? [];
    const words = !state ? ""
      : !state.valid ? text("now.comeBack", { reason: state.reason || text("now.noReading") })
      : silent.length ? text("now.silent", { names: silent.map(plain).join(", ") }) : "";
    this.why.hidden = !words;
    write(this.why, words);
  }
}

/** Place, share and source of a largest load. */
export function loadWords({ name, share, by, bridle }) {
  const source = by ? text("now.measuredBy", { name: plain(by) })
    : bridle.level > 1 ? text("now.predicted") : text("now.simulated");
  return text("now.largest", { name: plain(name), share: percent(share), source });
}

/** What is not well about something, in words; empty where nothing is. */
const concernOf = (state, kind) =>
  state?.concerns?.find((one) => one.kind === kind)?.message ?? "";

const way = (degrees) => `${bearing(degrees)} ${compass(degrees)}`;

function figure(name, pointer) {
  const [value, unit, note] = ["value", "unit", "note"].map((c) => make("span", { className: c }));
  const box = make("div", { className: "figure" }, make("dt", {}, text(`now.figure.${name}`)),
    make("dd", {}, make("span", { className: "figure-line" }, ...(pointer ? [pointer.arrow] : []), value, unit), note));
  const say = (number, its, words) => {
    write(value, number);
    write(unit, number === DASH ? "" : its);
    write(note, words);
  };
  const mark = (why) => {
    box.toggleAttribute("data-beyond", Boolean(why));
    box.title = why;
  };
  return { box, say, mark, turn: (degrees) => pointer.turn(degrees) };
}
