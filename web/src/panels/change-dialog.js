// Dialog in which people write down that the net was cleaned or changed, or a sensor moved.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { capital, titled } from "./format.js";
import { field, ReasonDialog } from "./reason-dialog.js";

const CHANGES = ["net-cleaned", "net-changed", "sensor-moved"];

export class ChangeDialog {
  constructor(desk) {
    this.desk = desk;
    this.change = make("select", { id: "change-what", onchange: () => this.choose() },
      ...CHANGES.map((value) => make("option", { value }, capital(text(`journal.action.${value}`)))));
    this.sensor = make("select", { id: "change-sensor" });
    this.which = field(text("change.sensor"), this.sensor);
    this.when = make("input", { id: "change-when", type: "datetime-local" });
    this.frame = new ReasonDialog("change", (why) => this.send(why),
      field(text("change.what"), this.change), this.which, field(text("change.when"), this.when));
  }

  ask() {
    const { depth_sensors = [], shackles = [] } = this.desk.model.topology ?? {};
    this.sensor.replaceChildren(...[...depth_sensors, ...shackles].map(({ name }) => make("option", { value: name }, titled(name))));
    this.when.value = "";
    this.choose();
    this.frame.ask({ title: text("change.title"), words: text("change.about"), word: text("change.word"),
      required: false, first: this.change });
  }

  choose() {
    this.which.hidden = this.change.value !== "sensor-moved";
  }

  send(why) {
    const sensor = this.which.hidden ? null : this.sensor.value;
    const t = this.when.value ? new Date(this.when.value).toISOString() : null;
    return this.desk.record({ change: this.change.value.replaceAll("-", " "), sensor, t, why });
  }
}
