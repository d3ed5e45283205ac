// How well the alarms do: too many, too long, too nervous alarms are not looked at.

import { make } from "../dom.js";
import { empty } from "./dom.js";
import { fixed, span } from "./format.js";
import { kpiRows } from "./kpi-rows.js";

export class Kpi {
  constructor(holder, desk, past) {
    Object.assign(this, { holder, desk, past, turn: 0 });
  }

  /** Ask for the counts over the span that is looked back over, and show them. */
  async show() {
    const turn = ++this.turn;
    const { start, end } = this.past;
    if (end === undefined) return;
    const [from, to] = [start, end + 1].map((t) => encodeURIComponent(new Date(t).toISOString()));
    const kpi = await this.desk.model.call("GET", this.desk.path(`kpi?from=${from}&to=${to}`))
      .catch((error) => error);
    if (turn !== this.turn) return;
    this.holder.replaceChildren(...content(kpi, (end - start) / 1000));
  }
}

function content(kpi, seconds) {
  if (kpi instanceof Error) return [empty("The counts did not come", kpi.message)];
  const rows = kpiRows(kpi);
  if (rows.length) return [figures(kpi, seconds), table(rows)];
  return [empty("No alarm in this span",
    "Counts begin with the first alarm. A longer span below looks further back.")];
}

function figures(kpi, seconds) {
  const raised = Object.values(kpi.raised).reduce((a, b) => a + b, 0);
  const all = [
    [fixed(kpi.per_day), "alarms per day", `${raised} in ${span(seconds)}, quiet ones included`],
    [String(kpi.most_in_an_hour), "most in an hour", "that called for somebody"],
    [String(Object.keys(kpi.standing).length), "standing", "raised and not yet cleared"],
    [String(kpi.chattering.length), "chattering", "raised three times within an hour"],
    [span(kpi.to_acknowledge_s), "to acknowledge", "half of them sooner"],
    [String(kpi.unacknowledged), "not acknowledged", "raised and never seen"],
  ];
  return make("dl", { className: "kpi" }, ...all.map(([value, name, note]) =>
    make("div", { className: "figure" }, make("dt", {}, name),
      make("dd", {}, make("span", { className: "value" }, value),
        make("span", { className: "note" }, note)))));
}

function table(rows) {
  const heads = ["Alarm", "Raised", "Longest", "State"];
  return make("table", { className: "journal" },
    make("caption", { className: "unseen" }, "Counts of each alarm"),
    make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head)))),
    make("tbody", {}, ...rows.map(({ name, raised, longestS, state }) =>
      make("tr", {}, make("td", {}, name), make("td", { className: "number" }, String(raised)),
        make("td", { className: "number" }, span(longestS)), make("td", {}, state)))));
}
