// Asks for a reason before the count of a line's damage begins anew, as after the line is replaced.

import { make } from "../dom.js";
import { cagePath } from "../request.js";
import { text } from "../texts/index.js";
import { write } from "./dom.js";
import { titled } from "./format.js";

export class ResetDialog {
  constructor(model) {
    this.model = model;
    this.about = make("p", { className: "dialog-about" });
    this.why = make("textarea", { id: "reset-why", rows: 3, maxLength: 500, required: true });
    this.fault = make("p", { className: "dialog-fault", role: "alert", hidden: true });
    this.go = make("button", { type: "submit", className: "button main" }, text("reset.word"));
    const form = make("form", { method: "dialog" }, make("h2", { id: "reset-title" }, text("reset.title")), this.about,
      make("p", { className: "dialog-words" }, text("reset.about")),
      make("div", { className: "field" }, make("label", { htmlFor: "reset-why" }, text("dialog.why")), this.why), this.fault,
      make("div", { className: "dialog-buttons" },
        make("button", { type: "button", className: "button", onclick: () => this.dialog.close() }, text("dialog.cancel")), this.go));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.send();
    });
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "reset-title" }, form);
    this.dialog.addEventListener("close", () => this.dialog.remove());
  }

  ask(line) {
    this.line = line;
    write(this.about, titled(line));
    this.why.value = "";
    this.say("");
    document.body.append(this.dialog);
    this.dialog.showModal();
    this.why.focus();
  }

  say(fault) {
    this.fault.hidden = !fault;
    write(this.fault, fault);
  }

  async send() {
    const why = this.why.value.trim();
    if (!why) return this.say(text("dialog.blank"));
    this.go.disabled = true;
    try {
      const path = `lines/${encodeURIComponent(this.line)}/damage/reset`;
      await this.model.call("POST", cagePath(this.model.cageName, path), { why });
      this.dialog.close();
    } catch (error) {
      this.say(error.message);
    }
    this.go.disabled = false;
  }
}
