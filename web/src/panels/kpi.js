// How well the alarms do: too many, too long, too nervous alarms are not looked at.

import { make } from "../dom.js";
import { empty } from "./dom.js";
import { fixed, span } from "./format.js";
import { linesOf } from "./journal.js";
import { counted } from "./kpi-counts.js";

export class Kpi {
  constructor(holder, desk, past) {
    Object.assign(this, { holder, desk, past, turn: 0 });
  }

  async show() {
    const turn = ++this.turn;
    const { start, end } = this.past;
    const lines = await linesOf(this.desk, this.past).catch((error) => error);
    if (turn !== this.turn) return;
    if (lines instanceof Error) return this.holder.replaceChildren(empty("The journal did not come", lines.message));
    const counts = counted(lines, { start, end });
    if (!counts.each.length) {
      return this.holder.replaceChildren(empty("No alarm in this span",
        "Counts begin with the first alarm. A longer span below looks further back."));
    }
    this.holder.replaceChildren(figures(counts, (end - start) / 1000), table(counts.each));
  }
}

function figures(counts, seconds) {
  const all = [
    [fixed(counts.perDay), "alarms per day", `${counts.raised} in ${span(seconds)}`],
    [String(counts.standing), "standing", "raised and not yet cleared"],
    [String(counts.chattering), "chattering", "raised three times in ten minutes"],
    [span(counts.longestS), "longest", "from raised to cleared, or to now"],
    [span(counts.seenAfterS), "to acknowledge", "half of them sooner"],
  ];
  return make("dl", { className: "kpi" }, ...all.map(([value, name, note]) =>
    make("div", { className: "figure" }, make("dt", {}, name),
      make("dd", {}, make("span", { className: "value" }, value),
        make("span", { className: "note" }, note)))));
}

function table(each) {
  const heads = ["Alarm", "Raised", "Longest", "State"];
  return make("table", { className: "journal" },
    make("caption", { className: "unseen" }, "Counts of each alarm"),
    make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head)))),
    make("tbody", {}, ...each.map(({ name, raised, longestS, standing, chatters }) =>
      make("tr", {}, make("td", {}, name), make("td", { className: "number" }, String(raised)),
        make("td", { className: "number" }, span(longestS)),
        make("td", {}, [standing && "standing", chatters && "chattering"].filter(Boolean).join(", ") || "over")))));
}
