// How well the alarms do: too many, too long, too nervous alarms are not looked at.

import { make } from "../dom.js";
import { alarmName } from "../service-words.js";
import { text } from "../texts/index.js";
import { empty, tableHead } from "./dom.js";
import { fixed, span } from "./format.js";
import { kpiRows } from "./kpi-rows.js";

export class Kpi {
  constructor(holder, desk, past) {
    Object.assign(this, { holder, desk, past, turn: 0 });
  }

  /** Ask for the counts over the span that is looked back over, and show them. */
  async show() {
    const turn = ++this.turn;
    const { start, end, query } = this.past;
    if (end === undefined) return;
    const kpi = await this.desk.model.call("GET", this.desk.path(`kpi?${query}`)).catch((error) => error);
    if (turn !== this.turn) return;
    this.holder.replaceChildren(...content(kpi, (end - start) / 1000));
  }
}

function content(kpi, seconds) {
  if (kpi instanceof Error) return [empty(text("kpi.failed"), kpi.message)];
  const rows = kpiRows(kpi);
  if (rows.length) return [figures(kpi, seconds), table(rows)];
  return [empty(text("kpi.empty"), text("kpi.longer"))];
}

function figures(kpi, seconds) {
  const raised = Object.values(kpi.raised).reduce((a, b) => a + b, 0);
  const all = [
    [fixed(kpi.per_day), "perDay"], [kpi.most_in_an_hour, "hour"],
    [Object.keys(kpi.standing).length, "stands"], [kpi.chattering.length, "chatters"],
    [span(kpi.to_acknowledge_s), "acknowledge"], [kpi.unacknowledged, "unseen"],
  ];
  return make("dl", { className: "kpi" }, ...all.map(([value, name]) =>
    make("div", { className: "figure" }, make("dt", {}, text(`kpi.figure.${name}.name`)),
      make("dd", {}, make("span", { className: "value" }, String(value)),
        make("span", { className: "note" }, text(`kpi.figure.${name}.note`, { raised, span: span(seconds) }))))));
}

function table(rows) {
  return make("table", { className: "journal" },
    make("caption", { className: "unseen" }, text("kpi.caption")),
    tableHead(["alarm", "raised", "longest", "state"].map((head) => text(`kpi.heads.${head}`))),
    make("tbody", {}, ...rows.map(({ name, raised, longestS, state }) =>
      make("tr", {}, make("td", {}, alarmName(name)), make("td", { className: "number" }, String(raised)),
        make("td", { className: "number" }, span(longestS)), make("td", {}, state)))));
}
