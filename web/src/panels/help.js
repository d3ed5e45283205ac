// What the page shows and which keys it knows.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { closeButton } from "./dom.js";

const KEYS = ["tabs", "live", "play", "step", "farm", "theme", "units", "view", "close", "help"];
const WORDS = ["twin", "load", "level", "envelope", "beyond", "invalid", "directions"];

export class Help {
  constructor() {
    this.dialog = make("dialog", { className: "sheet", "aria-labelledby": "help-title" },
      make("header", { className: "sheet-head" }, make("h2", { id: "help-title" }, text("help.title")),
        closeButton(() => this.dialog.close())),
      make("h3", {}, text("help.keys")),
      make("dl", { className: "keys" }, ...KEYS.flatMap((name) =>
        [make("dt", {}, make("kbd", {}, text(`help.key.${name}.keys`))),
          make("dd", {}, text(`help.key.${name}.does`))])),
      make("h3", {}, text("help.words")),
      make("dl", { className: "words" }, ...WORDS.flatMap((name) =>
        [make("dt", {}, text(`help.word.${name}.word`)), make("dd", {}, text(`help.word.${name}.means`))])),
      make("p", { className: "aside" }, text("help.aside")));
    document.body.append(this.dialog);
  }

  open() {
    if (!this.dialog.open) this.dialog.showModal();
  }
}
