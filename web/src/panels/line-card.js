// The panel of the line that is chosen, beside the net; on a phone a sheet over the page's foot.

import "./line-card.css";

import { make } from "../dom.js";
import { chosenLine, kindOf, lineIn } from "../lines.js";
import { text } from "../texts/index.js";
import { closeButton, write } from "./dom.js";
import { DASH, known, moment, percent, titled, withUnit } from "./format.js";
import { nowRows, partedRows, wearNote, wearRows, windowNote, windowRows } from "./line-rows.js";
import { ResetDialog } from "./reset-dialog.js";
import { may } from "./rights.js";

export class LineCard {
  constructor(holder, model, parting) {
    Object.assign(this, { model, parting });
    const reset = new ResetDialog(model);
    this.title = make("h2", { id: "line-title" });
    this.kind = make("p", { className: "line-kind" });
    this.figure = make("p", { className: "line-figure" });
    this.fill = make("div", { className: "line-fill" });
    this.most = make("div", { className: "line-most" });
    this.bar = make("div", { className: "line-bar", ariaHidden: "true" }, this.most, this.fill);
    this.reset = make("button", { type: "button", className: "button small", onclick: () => reset.ask(this.name) },
      text("reset.button"));
    this.again = make("button", { type: "button", className: "button small quiet",
      onclick: () => parting.ask({ anew: true }) }, text("parted.again"));
    this.parts = { now: section(), window: section(text("line.window")),
      wear: section(text("line.wear"), this.reset), parted: section(text("line.parted"), this.again) };
    this.element = make("section", { className: "line-card", "aria-labelledby": "line-title", tabIndex: -1, hidden: true },
      make("header", {}, make("div", {}, this.title, this.kind), closeButton(() => this.close())),
      this.figure, this.bar, ...Object.values(this.parts).map(({ element }) => element));
    this.element.addEventListener("keydown", (event) => { if (event.key === "Escape") this.close(); });
    holder.append(this.element);
    model.on("selection", () => this.chosen());
    model.on("view", () => this.show());
    parting.on(() => this.show());
  }

  /** Let go of the line; who came from a button goes back to it. */
  close() {
    const { from } = this;
    this.model.select(null);
    if (from?.isConnected) from.focus();
  }

  chosen() {
    const name = chosenLine(this.model.selection);
    if (name && name !== this.name) {
      if (!this.element.contains(document.activeElement)) this.from = document.activeElement;
      this.parting.ask();
    }
    this.name = name;
    this.show();
    if (name) this.element.scrollTop = 0;
  }

  show() {
    const { view, topology, session } = this.model;
    const { name } = this;
    this.element.hidden = !name || !view || !topology;
    if (this.element.hidden) return;
    const { state } = view;
    write(this.title, titled(name));
    const line = lineIn(state, name);
    const level = line?.level ?? state.bridles?.find((one) => one.name === name)?.level;
    write(this.kind, [text(`line.kind.${(kindOf(topology, name) ?? "line").replace(" ", "-")}`),
      level && text("line.level", { level })].filter(Boolean).join(", "));
    this.head(line);
    this.parts.now.say(nowRows(name, state));
    this.parts.window.say(windowRows(name, state), windowNote(name, state));
    this.parts.wear.say(wearRows(name, state), wearNote(name, state));
    this.reset.hidden = !known(line?.damage) || view.mode !== "live" || !may(session?.scopes ?? [], "ack");
    this.without(view);
  }

  /** The one number that matters first: how near the line comes to its capacity. */
  head(line) {
    const largest = line?.maximum_3h_kn.mean;
    const shared = known(line?.utilisation);
    const [value, words] = shared ? [percent(line.utilisation), text("line.shareIn3h")]
      : [known(largest) ? withUnit(largest, "kN") : DASH, text("line.in3h")];
    this.figure.hidden = !known(largest);
    this.figure.replaceChildren(make("b", {}, value), ` ${words}`);
    this.bar.hidden = !shared;
    if (!shared) return;
    const width = (share) => `${100 * Math.min(1, Math.max(0, share))}%`;
    this.most.style.width = width(line.utilisation);
    this.fill.style.width = width((line.utilisation * line.mean_kn) / largest);
  }

  without({ mode }) {
    const { answer, fault, asking, absent } = this.parting;
    const parted = this.parting.without(this.name);
    const reason = mode === "whatif" ? text("parted.imagined") : asking ? text("parted.asking")
      : fault || (!answer ? text("parted.notAsked") : !parted ? answer.reason || text("parted.notThis") : "");
    const of = parted ? [text("parted.of", { moment: moment(Date.parse(answer.time)) }),
      parted.in_domain === false ? text("parted.beyond") : ""].filter(Boolean).join(" ") : "";
    this.parts.parted.say(partedRows(parted), absent ? "" : reason || of);
    this.parts.parted.element.dataset.second = parted?.second_would_part ?? "";
    this.again.hidden = asking || mode === "whatif";
  }
}

/** A part of the panel: rows and a note, hidden without either. */
function section(title, ...buttons) {
  const list = make("dl");
  const note = make("p", { className: "aside" });
  const element = make("div", { className: "line-part" },
    ...(title ? [make("h3", {}, title)] : []), list, make("div", { className: "line-foot" }, note, ...buttons));
  let shown = "";
  const say = (rows, words = "") => {
    element.hidden = !rows.length && !words;
    note.hidden = !words;
    write(note, words);
    if (JSON.stringify(rows) === shown) return;
    shown = JSON.stringify(rows);
    list.replaceChildren(...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
  };
  return { element, say };
}
