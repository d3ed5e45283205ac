// The journal: who did what with which alarm, when and why.

import { make } from "../dom.js";
import { alarmName, sentences } from "../service-words.js";
import { has, text } from "../texts/index.js";
import { ChangeDialog } from "./change-dialog.js";
import { empty, tableHead } from "./dom.js";
import { DASH, day, time, zoneName } from "./format.js";
import { worth } from "./worth.js";

const MOST_LINES = 5000;
const SHOWN = 500; // lines; more nobody reads, and the browser would feel them

export class Journal {
  constructor(holder, model, desk, past) {
    const dialog = new ChangeDialog(desk);
    this.write = make("button", { type: "button", className: "button small", onclick: () => dialog.ask() }, text("change.button"));
    const lines = make("div");
    holder.append(make("p", { className: "journal-write" }, this.write), lines);
    Object.assign(this, { model, desk, past, holder: lines, turn: 0 });
  }

  /** Ask for the lines of the span that is looked back over, newest first, and show them. */
  async show() {
    this.write.hidden = this.desk.denied;
    const turn = ++this.turn;
    const words = await linesOf(this.desk, this.past).catch((error) => error);
    if (turn !== this.turn) return;
    if (words instanceof Error) return this.holder.replaceChildren(empty(text("journal.failed"), words.message));
    if (!words.length) {
      return this.holder.replaceChildren(empty(text("journal.empty"), text("journal.longer")));
    }
    this.holder.replaceChildren(make("table", { className: "journal" },
      make("caption", { className: "unseen" }, text("journal.caption")),
      tableHead(["when", "alarm", "what", "who"].map((head) => text(`journal.heads.${head}`, { zone: zoneName(Date.now()) }))),
      make("tbody", {}, ...words.reverse().slice(0, SHOWN).map(row))));
  }
}

/** The journal's lines over the span, in time order. */
export async function linesOf(desk, past) {
  if (past.end === undefined) return [];
  const { lines } = await desk.model.call("GET", desk.path(`journal?${past.query}&limit=${MOST_LINES}`));
  return [...lines].sort((a, b) => Date.parse(a.t) - Date.parse(b.t));
}

function row({ alarm, action, t, value, who, why, quiet }) {
  const [number, key] = [worth(alarm, value), action.replaceAll(" ", "-")];
  const word = has(`journal.action.${key}`) ? text(`journal.action.${key}`) : action;
  const done = number ? text("journal.at", { action: word, number }) : word;
  const line = make("tr", {}, make("td", { className: "when" }, `${day(Date.parse(t))} ${time(Date.parse(t))}`),
    make("td", {}, alarmName(alarm)), make("td", {}, quiet ? text("journal.quietly", { action: done }) : done),
    make("td", {}, [who, sentences(why)].filter(Boolean).join(": ") || DASH));
  line.dataset.action = action;
  return line;
}
