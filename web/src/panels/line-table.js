// All lines in waves: their mean and the largest tension expected in three hours.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { unitName } from "../units.js";
import { tableHead, write } from "./dom.js";
import { amount, known, percent, plain, titled, withUnit } from "./format.js";

/** A table that opens at its summary, which names the line that bears most. */
export class LineTable {
  /** `pick` is called with the name of the line that was chosen. */
  constructor({ pick }) {
    this.pick = pick;
    this.summary = make("summary");
    this.body = make("tbody");
    this.about = make("p", { className: "aside" });
    this.drawing = make("details", { className: "lines", hidden: true }, this.summary,
      make("table", { className: "loads" },
        make("caption", { className: "unseen" }, text("lines.caption")),
        tableHead(["line", "mean", "std", "maximum"].map((head) => text(`lines.heads.${head}`))),
        this.body),
      this.about);
  }

  show(state) {
    const lines = state.lines ?? [];
    this.drawing.hidden = !lines.length;
    write(this.summary, heaviest(lines, state));
    write(this.about, [text("lines.about", { unit: unitName("kN") }), lines.length && state.lines_reason].filter(Boolean).join(" "));
    const names = lines.map(({ name }) => name).join();
    if (names !== this.names) this.build(lines, names);
    lines.forEach(({ mean_kn: mean, std_kn: std, maximum_3h_kn: largest }, k) => {
      [mean, std, largest.mean].forEach((kn, column) => write(this.cells[k][column], amount(kn, "kN")));
    });
  }

  build(lines, names) {
    this.names = names;
    this.cells = lines.map(() => ["mean", "std", "maximum"].map(() => make("td", { className: "number" })));
    this.rows = lines.map(({ name, kind }, k) => make("tr",
      { className: k && kind !== lines[k - 1].kind ? "next-corner" : "" },
      make("th", { scope: "row" }, make("button", { type: "button", onclick: () => this.pick(name) }, titled(name))),
      ...this.cells[k]));
    lines.forEach(({ name }, k) => { this.rows[k].dataset.line = name; });
    this.body.replaceChildren(...this.rows);
    this.select(this.chosen);
  }

  /** Mark the line that is chosen; null none. */
  select(chosen) {
    this.chosen = chosen;
    for (const row of this.rows ?? []) {
      const its = row.dataset.line === chosen;
      row.toggleAttribute("data-chosen", its);
      row.querySelector("button").setAttribute("aria-pressed", its);
    }
  }
}

/**
 * The line that comes nearest its capacity in three hours of this sea, where any capacity is
 * known, else the one that bears most; or why none is known.
 */
export function heaviest(lines, state) {
  const loaded = lines.filter(({ maximum_3h_kn: largest }) => known(largest.mean));
  if (!loaded.length) return text("lines.none", { reason: state.lines_reason || state.reason || "" });
  const shared = loaded.filter(({ utilisation }) => known(utilisation));
  const size = ({ maximum_3h_kn: largest, utilisation }) => (shared.length ? utilisation : largest.mean);
  const most = (shared.length ? shared : loaded).reduce((a, b) => (size(b) > size(a) ? b : a));
  const about = { name: plain(most.name), load: withUnit(most.maximum_3h_kn.mean, "kN") };
  return shared.length
    ? text("lines.share", { ...about, share: percent(most.utilisation) }) : text("lines.most", about);
}
