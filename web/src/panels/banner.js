// A band under the top line, wherever what is shown is not the sea now.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { write } from "./dom.js";
import { moment, span } from "./format.js";
import { icon } from "./icons.js";

export class Banner {
  constructor(holder, model) {
    this.model = model;
    this.mark = make("span", { className: "banner-mark" });
    this.head = make("strong");
    this.words = make("span");
    const back = make("button", { type: "button", className: "button small", onclick: () => model.travel(null) },
      text("banner.live"));
    this.band = make("div", { className: "banner", role: "status", hidden: true },
      this.mark, make("p", {}, this.head, " ", this.words), back);
    holder.append(this.band);
    for (const name of ["view", "live"]) model.on(name, () => this.show());
  }

  show() {
    const { view, live } = this.model;
    const mode = view?.mode ?? "live";
    this.band.hidden = mode === "live";
    if (mode === "live") return;
    if (this.band.dataset.mode !== mode) this.mark.replaceChildren(icon(mode));
    this.band.dataset.mode = mode;
    write(this.head, text(`banner.head.${mode}`));
    if (mode === "past") {
      const shown = { moment: moment(view.t), ago: live && span((live.t - view.t) / 1000) };
      write(this.words, live ? text("banner.shownAgo", shown) : text("banner.shown", shown));
    } else write(this.words, text("banner.chosen"));
  }
}
