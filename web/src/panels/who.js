// Who is signed in, and the way out.

import { make } from "../dom.js";
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
      make("h2", { id: "who-title" }, "Signed in"), this.name, this.may,
      make("p", { className: "dialog-words" }, "To come back after signing out takes a token again."),
      this.fault, make("div", { className: "dialog-buttons" },
        make("button", { type: "button", className: "button", onclick: () => this.dialog.close() }, "Stay"),
        make("button", { type: "button", className: "button main", onclick: () => this.leave() }, "Sign out")));
    document.body.append(this.dialog);
    this.button = make("button", { type: "button", className: "round", hidden: true,
      onclick: () => this.open() }, icon("who"));
    model.on("session", ({ who, scopes }) => {
      write(this.name, `Token “${who}”`);
      write(this.may, rights(scopes));
      this.button.title = this.button.ariaLabel = `Signed in as ${who}; sign out`;
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
      write(this.fault, `You are still signed in: ${error.message}`);
    }
  }
}
