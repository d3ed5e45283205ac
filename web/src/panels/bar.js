// The top line: whose cage, whether all is well, how old the news is.

import { make } from "../dom.js";
import { write } from "./dom.js";
import { day, span, time } from "./format.js";
import { icon } from "./icons.js";
import { rank, waits } from "./ranks.js";
import { themeSwitch } from "./theme-switch.js";
import { verdict } from "./verdict.js";
import { Who } from "./who.js";

const LINKS = {
  live: "Live", connecting: "Connecting", lost: "Connection lost, trying again",
  refused: "Not admitted", asking: "Waiting for a token",
};

export class Bar {
  constructor(holder, model, { openFarm, openHelp }) {
    this.model = model;
    this.cage = make("span", { className: "cage-name" }, "seacage");
    this.cages = make("button", { className: "cage-button", type: "button", onclick: openFarm },
      icon("farm"), this.cage, make("span", { className: "unseen" }, ", choose a cage"));
    this.origin = make("span", { className: "badge origin", hidden: true });
    this.mark = make("span", { className: "verdict-mark" });
    this.headline = make("strong", { className: "verdict-headline" });
    this.detail = make("span", { className: "verdict-detail" });
    this.verdict = make("div", { className: "verdict", role: "status" },
      this.mark, make("div", { className: "verdict-words" }, this.headline, this.detail));
    this.age = make("span", { className: "badge age" });
    this.clock = make("time", { className: "clock" });
    this.speed = make("span", { className: "badge speed", hidden: true });
    this.link = make("span", { className: "link", role: "status" });
    const help = make("button", {
      className: "round", type: "button", title: "Help and keys (?)", ariaLabel: "Help and keys",
      onclick: openHelp,
    }, icon("help"));
    const time = make("div", { className: "bar-time" }, this.clock, this.speed, this.age);
    holder.append(
      make("div", { className: "bar-who" }, make("h1", {}, this.cages), this.origin), this.verdict,
      time, make("div", { className: "bar-tools" }, this.link, themeSwitch(), help, new Who(model).button));
    model.on("topology", () => this.topology());
    for (const name of ["live", "view", "connection", "age"]) model.on(name, () => this.show());
    // On a phone the tabs stop beneath the bar, however high that is.
    new ResizeObserver(([{ target }]) =>
      document.documentElement.style.setProperty("--bar-height", `${target.offsetHeight}px`))
      .observe(holder.parentElement);
    this.topology();
    this.show();
  }

  topology() {
    const topology = this.model.topology;
    if (!topology) return;
    write(this.cage, topology.cage);
    this.origin.hidden = topology.origin === "measured";
    write(this.origin, topology.origin);
    this.origin.title = "How the sensors' numbers were made: this is no sea that was measured.";
    this.speed.hidden = topology.speed === 1;
    write(this.speed, `replay ${topology.speed} ×`);
  }

  show() {
    const { live, connection, why } = this.model;
    this.judge(verdict({ connection, why, live }));
    this.link.dataset.connection = connection;
    write(this.link, LINKS[connection] ?? connection);
    if (!live) return;
    write(this.clock, `${day(live.t)} ${time(live.t, true)} UTC`);
    this.clock.dateTime = new Date(live.t).toISOString();
    this.old(live.ageS);
    this.entitle(live.state);
  }

  judge({ kind, icon: shape, headline, detail }) {
    const elsewhere = (this.model.view?.mode ?? "live") !== "live";
    this.verdict.dataset.kind = kind;
    if (this.mark.dataset.shape !== shape) this.mark.replaceChildren(icon(shape));
    this.mark.dataset.shape = shape;
    // The verdict is on the sea now, even while the reader looks at another.
    write(this.headline, elsewhere ? `Now: ${headline}` : headline);
    write(this.detail, detail);
    this.detail.title = detail;
  }

  old(age) {
    const limit = this.model.topology?.stale_after_s ?? Infinity;
    write(this.age, age === null ? "no input yet" : `input ${span(age)} old`);
    this.age.dataset.old = age === null || age > limit / 2;
    this.age.title = Number.isFinite(limit)
      ? `The newest reading of the buoy; it counts for ${span(limit)}.` : "";
  }

  /** Say in the tab's title what would make somebody come back to it. */
  entitle({ alarms = [], valid, cage }) {
    const unseen = alarms.filter((alarm) => waits(alarm) && !alarm.acknowledged);
    const urgent = unseen.some((alarm) => rank(alarm.severity) === "critical") ? "! " : "";
    const count = unseen.length ? `(${urgent}${unseen.length}) ` : "";
    const title = `${count}${cage}${valid ? "" : ", no valid input"} · seacage`;
    if (document.title !== title) document.title = title;
  }
}
