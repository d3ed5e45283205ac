// Dialog before the count of a line's damage begins anew, as after the line is replaced.

import { cagePath } from "../request.js";
import { text } from "../texts/index.js";
import { titled } from "./format.js";
import { ReasonDialog } from "./reason-dialog.js";

export class ResetDialog {
  constructor(model) {
    this.model = model;
    this.frame = new ReasonDialog("reset", (why) => this.send(why));
  }

  ask(line) {
    this.line = line;
    this.frame.ask({ title: text("reset.title"), about: titled(line), words: text("reset.about"), word: text("reset.word") });
  }

  send(why) {
    const path = `lines/${encodeURIComponent(this.line)}/damage/reset`;
    return this.model.call("POST", cagePath(this.model.cageName, path), { why });
  }
}
