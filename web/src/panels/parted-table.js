// "If this line parted now": all lines, the worst first.

import { make } from "../dom.js";
import { selectionOf } from "../lines.js";
import { text } from "../texts/index.js";
import { tableHead, write } from "./dom.js";
import { DASH, known, moment, percent, plain, titled, withUnit } from "./format.js";
import { second } from "./parting.js";

/** A table that asks when it is opened. */
export class PartedTable {
  constructor(model, parting) {
    Object.assign(this, { model, parting });
    this.body = make("tbody");
    this.note = make("p", { className: "aside", role: "status" });
    this.again = make("button", { type: "button", className: "button small", onclick: () => parting.ask({ anew: true }) },
      text("parted.again"));
    this.table = make("table", { className: "loads parted" },
      make("caption", { className: "unseen" }, text("parted.caption")),
      tableHead(["line", "load", "share", "second", "volume"].map((head) => text(`parted.heads.${head}`))), this.body);
    this.drawing = make("details", { className: "lines" }, make("summary", {}, text("parted.title")),
      make("div", { className: "table-holder" }, this.table), make("div", { className: "line-foot" }, this.note, this.again));
    this.drawing.addEventListener("toggle", () => { if (this.drawing.open) parting.ask(); });
    parting.on(() => this.show());
    model.on("topology", () => { this.drawing.open = false; });
    this.show();
  }

  show() {
    const { answer, fault, asking, absent } = this.parting;
    const { view } = this.model;
    const lines = answer?.lines ?? [];
    // Without a single loaded line there is no sea of waves to ask about.
    this.drawing.hidden = absent || !this.model.topology?.lines?.length;
    this.table.hidden = !lines.length;
    this.body.replaceChildren(...lines.map((one) => this.row(one)));
    this.again.hidden = asking || view?.mode === "whatif";
    write(this.note, view?.mode === "whatif" ? text("parted.imagined") : asking ? text("parted.asking")
      : fault || (!answer && text("parted.notAsked")) || answer?.reason || `${text("parted.of", { moment: moment(Date.parse(answer.time)) })} ${text("parted.about")}`);
  }

  row(one) {
    const { parted, utilisation, volume_share: volume, in_domain: within } = one;
    const load = one.largest_maximum_3h ?? one.largest_mean;
    const button = make("button", { type: "button",
      onclick: () => this.model.select(selectionOf(this.model.topology, parted)) }, titled(parted));
    const cell = (...words) => make("td", { className: "number" }, ...words);
    return make("tr", {}, make("th", { scope: "row" }, button, within === false
      ? make("span", { className: "level outside", title: text("parted.beyond") }, text("parted.outside")) : ""),
    cell(load && known(load.kn) ? withUnit(load.kn, "kN") : DASH, load ? make("small", {}, ` ${plain(load.line)}`) : ""),
    cell(percent(utilisation)), cell(second(one)), cell(percent(volume)));
  }
}
