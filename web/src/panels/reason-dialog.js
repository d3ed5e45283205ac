// Frame of the dialogs that ask for a reason before something is done.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { write } from "./dom.js";

export class ReasonDialog {
  /** `name` begins the ids; `send` gets the reason, and what it fails with is shown; `fields` stand above the reason. */
  constructor(name, send, ...fields) {
    this.title = make("h2", { id: `${name}-title` });
    this.about = make("p", { className: "dialog-about" });
    this.words = make("p", { className: "dialog-words" });
    this.why = make("textarea", { id: `${name}-why`, rows: 3, maxLength: 500 });
    this.reason = field("", this.why);
    this.fault = make("p", { className: "dialog-fault", role: "alert" });
    this.go = make("button", { type: "submit", className: "button main" });
    const leave = make("button", { type: "button", className: "button", onclick: () => this.dialog.close() },
      text("dialog.cancel"));
    const form = make("form", { method: "dialog" }, this.title, this.about, this.words, ...fields, this.reason,
      this.fault, make("div", { className: "dialog-buttons" }, leave, this.go));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.submit(send);
    });
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": `${name}-title` }, form);
    this.dialog.addEventListener("close", () => this.dialog.remove());
  }

  /** Open it, empty; `first` has the focus. */
  ask({ title, about = "", words, word, required = true, first = this.why }) {
    write(this.title, title);
    write(this.about, about);
    write(this.words, words);
    write(this.go, word);
    write(this.reason.firstChild, required ? text("dialog.why") : text("dialog.whyOrNot"));
    this.about.hidden = !about;
    this.why.required = required;
    this.why.value = "";
    this.go.disabled = false;
    this.say("");
    document.body.append(this.dialog);
    this.dialog.showModal();
    first.focus();
  }

  say(fault) {
    this.fault.hidden = !fault;
    write(this.fault, fault);
  }

  async submit(send) {
    const why = this.why.value.trim();
    if (this.why.required && !why) return this.say(text("dialog.blank"));
    this.go.disabled = true;
    try {
      await send(why);
      this.dialog.close();
    } catch (error) {
      this.say(error.message);
      this.go.disabled = false;
    }
  }
}

/** An input below its label. */
export const field = (words, input) =>
  make("div", { className: "field" }, make("label", { htmlFor: input.id }, words), input);
