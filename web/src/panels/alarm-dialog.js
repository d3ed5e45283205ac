// Dialog for a reason, before anything is done with an alarm.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { REASONED, shelvesFor } from "./alarm-actions.js";
import { field, ReasonDialog } from "./reason-dialog.js";

export class AlarmDialog {
  constructor(desk) {
    this.desk = desk;
    this.times = make("select", { id: "alarm-time" });
    this.time = field(text("dialog.time"), this.times);
    this.frame = new ReasonDialog("alarm", (why) => this.send(why), this.time);
  }

  /** Ask for a reason for an action on an alarm, or for acknowledging a group of one cause. */
  ask(alarm, name, group = null) {
    Object.assign(this, { alarm, name, group });
    this.time.hidden = name !== "shelve";
    this.times.replaceChildren(...shelvesFor(alarm).map(([words, seconds]) =>
      make("option", { value: seconds ?? "" }, words)));
    this.times.selectedIndex = 1;
    this.frame.ask({
      title: group ? text("dialog.group", { count: group.ids.length }) : text(`actions.${name}.title`),
      about: (group ?? alarm).title,
      words: text(`actions.${name}.about`),
      word: text(`actions.${name}.word`),
      required: REASONED.has(name),
    });
  }

  send(why) {
    if (this.group) return this.desk.acknowledge(this.group.ids, { why });
    const seconds = this.name === "shelve" && this.times.value ? Number(this.times.value) : null;
    return this.desk.act(this.alarm.id, this.name, { why, seconds });
  }
}
