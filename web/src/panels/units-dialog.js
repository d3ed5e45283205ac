// Which units and which clock the page shows.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { CHOICES, choiceOf, choose, hasSiteZone, zone } from "../units.js";
import { closeButton, write } from "./dom.js";

const KEYS = { kN: "force", "m/s": "speed", m: "length", clock: "clock" };

export class UnitsDialog {
  constructor() {
    this.zone = make("p", { className: "aside", role: "status" });
    this.fields = make("div", { className: "unit-fields" });
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "units-title" },
      make("header", { className: "sheet-head" }, make("h2", { id: "units-title" }, text("units.title")),
        closeButton(() => this.dialog.close())),
      this.fields, this.zone, make("p", { className: "aside" }, text("units.about")));
    document.body.append(this.dialog);
  }

  open() {
    this.fields.replaceChildren(...CHOICES.map(([name, choices]) => this.field(name,
      choices.filter((choice) => choice !== "site" || hasSiteZone()))));
    this.say();
    if (!this.dialog.open) this.dialog.showModal();
  }

  field(name, choices) {
    const inputs = choices.map((choice) => {
      const input = make("input", { type: "radio", name: `unit-${name}`, value: choice, checked: choiceOf(name) === choice });
      input.addEventListener("change", () => {
        choose(name, choice);
        this.say();
      });
      return make("label", { className: "pill" }, input,
        make("span", {}, name === "clock" ? text(`units.clock.${choice}`) : choice));
    });
    return make("fieldset", {}, make("legend", {}, text(`units.kind.${KEYS[name]}`)), ...inputs);
  }

  say() {
    write(this.zone, text("units.zone", { zone: zone() }));
  }
}
