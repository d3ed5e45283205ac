// Who is signed in, and the way out.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { write } from "./dom.js";
import { icon } from "./icons.js";
import { rights } from "./rights.js";

export class Who {
  constructor(model) {
    this.model = model;
    this.name = make("p", { className: "dialog-about" });
    this.may = make("p", { className: "dialog-words" });
    this.fault = make("p", { className: "dialog-fault", role: "alert", hidden: true });
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "who-title" },
      make("h2", { id: "who-title" }, text("who.title")), this.name, this.may,
      make("p", { className: "dialog-words" }, text("who.back")),
      this.fault, make("div", { className: "dialog-buttons" },
        make("button", { type: "button", className: "button", onclick: () => this.dialog.close() }, text("who.stay")),
        make("button", { type: "button", className: "button main", onclick: () => this.leave() }, text("who.leave"))));
    document.body.append(this.dialog);
    this.button = make("button", { type: "button", className: "round", hidden: true,
      onclick: () => this.open() }, icon("who"));
    model.on("session", ({ who, scopes }) => {
      write(this.name, text("who.token", { who }));
      write(this.may, rights(scopes));
      this.button.title = this.button.ariaLabel = text("who.button", { who });
      this.button.hidden = false;
    });
    model.on("connection", (connection) => { if (connection === "asking") this.dialog.close(); });
  }

  open() {
    this.fault.hidden = true;
    if (!this.dialog.open) this.dialog.showModal();
  }

  async leave() {
    try {
      await this.model.leave();
    } catch (error) {
      this.fault.hidden = false;
      write(this.fault, text("who.fault", { fault: error.message }));
    }
  }
}
