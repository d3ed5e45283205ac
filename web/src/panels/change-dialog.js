// Dialog in which people write down that the net was cleaned or changed, or a sensor moved.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { write } from "./dom.js";

const CHANGES = ["net-cleaned", "net-changed", "sensor-moved"];

export class ChangeDialog {
  constructor(desk) {
    this.desk = desk;
    this.change = make("select", { id: "change-what" },
      ...CHANGES.map((value) => make("option", { value }, text(`journal.action.${value}`))));
    this.sensor = make("select", { id: "change-sensor" });
    this.which = field("change-sensor", text("change.sensor"), this.sensor);
    this.when = make("input", { id: "change-when", type: "datetime-local" });
    this.why = make("textarea", { id: "change-why", rows: 3, maxLength: 500 });
    this.fault = make("p", { className: "dialog-fault", role: "alert", hidden: true });
    this.go = make("button", { type: "submit", className: "button main" }, text("change.word"));
    const form = make("form", { method: "dialog" }, make("h2", { id: "change-title" }, text("change.title")),
      make("p", { className: "dialog-words" }, text("change.about")),
      field("change-what", text("change.what"), this.change), this.which,
      field("change-when", text("change.when"), this.when), field("change-why", text("dialog.whyOrNot"), this.why), this.fault,
      make("div", { className: "dialog-buttons" },
        make("button", { type: "button", className: "button", onclick: () => this.dialog.close() }, text("dialog.cancel")), this.go));
    this.change.addEventListener("change", () => this.chosen());
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.send();
    });
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "change-title" }, form);
    this.dialog.addEventListener("close", () => this.dialog.remove());
  }

  ask() {
    const { depth_sensors = [], shackles = [] } = this.desk.model.topology ?? {};
    this.sensor.replaceChildren(...[...depth_sensors, ...shackles].map(({ name }) => make("option", { value: name }, name)));
    this.when.value = this.why.value = "";
    this.say("");
    this.chosen();
    document.body.append(this.dialog);
    this.dialog.showModal();
    this.change.focus();
  }

  chosen() {
    this.which.hidden = this.change.value !== "sensor-moved";
  }

  say(fault) {
    this.fault.hidden = !fault;
    write(this.fault, fault);
  }

  async send() {
    const sensor = this.which.hidden ? null : this.sensor.value;
    const t = this.when.value ? new Date(this.when.value).toISOString() : null;
    this.go.disabled = true;
    try {
      await this.desk.record({ change: this.change.value.replaceAll("-", " "), sensor, t, why: this.why.value.trim() });
      this.dialog.close();
    } catch (error) {
      this.say(error.message);
    }
    this.go.disabled = false;
  }
}

function field(id, words, input) {
  return make("div", { className: "field" }, make("label", { htmlFor: id }, words), input);
}
