// The journal: who did what with which alarm, when and why.

import { make } from "../dom.js";
import { empty } from "./dom.js";
import { moment } from "./format.js";
import { worth } from "./worth.js";

const MOST_LINES = 5000;
const SHOWN = 500; // lines; more nobody reads, and the browser would feel them

export class Journal {
  constructor(holder, model, desk, past) {
    Object.assign(this, { model, desk, past, lines: [], holder });
    this.turn = 0;
  }

  /** Ask for the lines of the span that is looked back over, newest first, and show them. */
  async show() {
    const turn = ++this.turn;
    const words = await linesOf(this.desk, this.past).catch((error) => error);
    if (turn !== this.turn) return;
    if (words instanceof Error) return this.holder.replaceChildren(empty("The journal did not come", words.message));
    if (!words.length) {
      return this.holder.replaceChildren(empty("Nothing is written",
        "No alarm was raised or handled in this span. A longer span below looks further back."));
    }
    this.holder.replaceChildren(make("table", { className: "journal" },
      make("caption", { className: "unseen" }, "Journal of alarms, newest first"),
      make("thead", {}, make("tr", {}, ...["When, UTC", "Alarm", "What", "Who and why"]
        .map((head) => make("th", { scope: "col" }, head)))),
      make("tbody", {}, ...words.reverse().slice(0, SHOWN).map(row))));
  }
}

/** The journal's lines over the span, in time order. */
export async function linesOf(desk, past) {
  if (past.end === undefined) return [];
  const [from, to] = [past.start, past.end + 1].map((t) => encodeURIComponent(new Date(t).toISOString()));
  const { lines } = await desk.model.call("GET",
    desk.path(`journal?from=${from}&to=${to}&limit=${MOST_LINES}`));
  return [...lines].sort((a, b) => Date.parse(a.t) - Date.parse(b.t));
}

function row({ alarm, action, t, value, who, why, quiet }) {
  const number = worth(alarm, value);
  const line = make("tr", {}, make("td", { className: "when" }, moment(Date.parse(t)).replace(" UTC", "")),
    make("td", {}, alarm), make("td", {}, `${action}${number && ` at ${number}`}${quiet ? ", quietly" : ""}`),
    make("td", {}, [who, why].filter(Boolean).join(": ") || "–"));
  line.dataset.action = action;
  return line;
}
