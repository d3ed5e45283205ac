// Dialog for a reason, before anything is done with an alarm.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { REASONED, shelvesFor } from "./alarm-actions.js";
import { write } from "./dom.js";

export class AlarmDialog {
  constructor(desk) {
    this.desk = desk;
    this.title = make("h2", { id: "alarm-dialog-title" });
    this.about = make("p", { className: "dialog-about" });
    this.words = make("p", { className: "dialog-words" });
    this.why = make("textarea", { id: "alarm-why", rows: 3, maxLength: 500 });
    this.label = make("label", { htmlFor: "alarm-why" });
    this.times = make("select", { id: "alarm-time" });
    this.time = make("div", { className: "field" },
      make("label", { htmlFor: "alarm-time" }, text("dialog.time")), this.times);
    this.fault = make("p", { className: "dialog-fault", role: "alert", hidden: true });
    this.go = make("button", { type: "submit", className: "button main" });
    const leave = make("button", { type: "button", className: "button", onclick: () => this.dialog.close() },
      text("dialog.cancel"));
    const form = make("form", { method: "dialog" }, this.title, this.about, this.words, this.time,
      make("div", { className: "field" }, this.label, this.why), this.fault,
      make("div", { className: "dialog-buttons" }, leave, this.go));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.send();
    });
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "alarm-dialog-title" }, form);
    document.body.append(this.dialog);
  }

  /** Ask for a reason for an action on an alarm, or for acknowledging a group of one cause. */
  ask(alarm, name, group = null) {
    Object.assign(this, { alarm, name, group });
    write(this.title, group ? text("dialog.group", { count: group.ids.length }) : text(`actions.${name}.title`));
    write(this.about, group ? group.title : alarm.title);
    write(this.words, text(`actions.${name}.about`));
    write(this.go, text(`actions.${name}.word`));
    this.why.required = REASONED.has(name);
    write(this.label, this.why.required ? text("dialog.why") : text("dialog.whyOrNot"));
    this.why.value = "";
    this.time.hidden = name !== "shelve";
    this.times.replaceChildren(...shelvesFor(alarm).map(([words, seconds]) =>
      make("option", { value: seconds ?? "" }, words)));
    this.times.selectedIndex = 1;
    this.say("");
    this.go.disabled = false;
    this.dialog.showModal();
    this.why.focus();
  }

  say(fault) {
    this.fault.hidden = !fault;
    write(this.fault, fault);
  }

  async send() {
    const seconds = this.name === "shelve" && this.times.value ? Number(this.times.value) : null;
    const why = this.why.value.trim();
    if (this.why.required && !why) return this.say(text("dialog.blank"));
    this.go.disabled = true;
    try {
      if (this.group) await this.desk.acknowledge(this.group.ids, { why });
      else await this.desk.act(this.alarm.id, this.name, { why, seconds });
      this.dialog.close();
    } catch (error) {
      this.say(error.message);
      this.go.disabled = false;
    }
  }
}
