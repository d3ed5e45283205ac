// News, shown once at the edge of the page.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { grouped, titleOf } from "./alarm-groups.js";
import { closeButton } from "./dom.js";
import { plain } from "./format.js";
import { fresh } from "./fresh.js";
import { icon } from "./icons.js";
import { sourceOf } from "./load-rows.js";
import { rank } from "./ranks.js";
import { sound } from "./sound.js";

const STAY_MS = 12_000;
const MOST = 4;

export class Toasts {
  /** `look` brings the alarms into view. */
  constructor(model, { look }) {
    this.look = look;
    this.before = null;
    this.polite = make("div", { role: "status" });
    this.urgent = make("div", { role: "alert" });
    this.stack = make("div", { className: "toasts" }, this.urgent, this.polite);
    document.body.append(this.stack);
    model.on("topology", () => { this.before = null; });
    model.on("live", ({ state }) => this.compare(state.alarms ?? []));
    model.on("trouble", (error) => this.put("note", text("page.trouble"), error.message));
  }

  /** Announce new alarms; those that were there when the page opened are no news. */
  compare(alarms) {
    const news = this.before ? fresh(this.before, alarms) : [];
    this.before = alarms;
    for (const group of grouped(news)) this.announce(group);
    const worst = ["critical", "warning", "note"]
      .find((one) => news.some(({ severity }) => rank(severity) === one));
    if (worst) sound(worst);
  }

  announce(group) {
    const worst = group.reduce((a, b) => (b.severity > a.severity ? b : a));
    const words = group.length === 1 ? worst.message
      : group.map(({ id }) => plain(sourceOf(id))).join(", ");
    this.put(rank(worst.severity), titleOf(group), words, true);
  }

  put(how, title, words, isAlarm = false) {
    const toast = make("div", { className: "toast" }, icon(how),
      make("div", {}, make("strong", {}, title), make("p", {}, words)));
    toast.dataset.rank = isAlarm ? how : "trouble";
    const gone = () => toast.remove();
    if (isAlarm) {
      toast.append(make("button", { type: "button", className: "button small", onclick: () => {
        gone();
        this.look();
      } }, text("alarms.look")));
    }
    toast.append(closeButton(gone));
    (how === "critical" ? this.urgent : this.polite).append(toast);
    // A critical one stays until somebody takes it away.
    if (how !== "critical") setTimeout(gone, STAY_MS);
    const all = this.stack.querySelectorAll(".toast");
    if (all.length > MOST) all[0].remove();
  }
}
