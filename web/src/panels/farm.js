// The farm: all cages of the service, the worst first.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { closeButton, write } from "./dom.js";
import { byNeed, summed, tile } from "./farm-tile.js";

export class Farm {
  constructor(model) {
    this.model = model;
    this.tiles = make("div", { className: "tiles" });
    this.sum = make("p", { className: "aside" });
    const close = closeButton(() => this.dialog.close());
    this.dialog = make("dialog", { className: "sheet wide", "aria-labelledby": "farm-title" },
      make("header", { className: "sheet-head" },
        make("div", {}, make("h2", { id: "farm-title" }, text("farm.title")), this.sum), close),
      this.tiles);
    document.body.append(this.dialog);
    // Who was sent to one cage sees that; who was sent to the farm sees all.
    let begins = !new URLSearchParams(location.search).has("cage");
    model.on("cages", (cages) => {
      if (begins && cages.length > 1) this.open();
      begins = false;
      this.show();
    });
  }

  open() {
    this.show();
    if (!this.dialog.open) this.dialog.showModal();
    (this.tiles.querySelector("[aria-current]") ?? this.tiles.firstElementChild)?.focus();
  }

  show() {
    const { cages, cageName } = this.model;
    const kept = this.tiles.contains(document.activeElement)
      ? [...this.tiles.children].indexOf(document.activeElement) : -1;
    this.tiles.replaceChildren(...byNeed(cages).map((cage) =>
      tile(cage, { present: cage.name === cageName, enter: (name) => this.enter(name) })));
    if (kept >= 0) this.tiles.children[kept]?.focus();
    write(this.sum, summed(cages));
  }

  enter(name) {
    this.dialog.close();
    if (name !== this.model.cageName) this.model.cage(name);
  }
}
