// The top line: whose cage, whether all is well, how old the news is.

import { make } from "../dom.js";
import { word } from "../service-words.js";
import { text } from "../texts/index.js";
import { write } from "./dom.js";
import { day, inputAge, span, time, zoneName } from "./format.js";
import { icon } from "./icons.js";
import { languageSwitch } from "./language-switch.js";
import { rank, waits } from "./ranks.js";
import { themeSwitch } from "./theme-switch.js";
import { verdict } from "./verdict.js";
import { Who } from "./who.js";

export class Bar {
  constructor(holder, model, { openFarm, openHelp, openUnits }) {
    this.model = model;
    this.cage = make("span", { className: "cage-name" }, "seacage");
    this.cages = make("button", { className: "cage-button", type: "button", onclick: openFarm },
      icon("farm"), this.cage, make("span", { className: "unseen" }, text("bar.choose")));
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
      className: "round", type: "button", title: `${text("bar.help")} (?)`, ariaLabel: text("bar.help"),
      onclick: openHelp,
    }, icon("help"));
    const units = make("button", { className: "round", type: "button", title: `${text("units.title")} (U)`,
      ariaLabel: text("units.title"), onclick: openUnits }, icon("units"));
    const time = make("div", { className: "bar-time" }, this.clock, this.speed, this.age);
    holder.append(
      make("div", { className: "bar-who" }, make("h1", {}, this.cages), this.origin), this.verdict,
      time, make("div", { className: "bar-tools" }, this.link, themeSwitch(), languageSwitch(), units, help, new Who(model).button));
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
    write(this.origin, word(topology.origin));
    this.origin.title = text("bar.origin");
    this.speed.hidden = topology.speed === 1;
    write(this.speed, text("bar.replay", { speed: topology.speed }));
  }

  show() {
    const { live, connection, why } = this.model;
    this.showVerdict(verdict({ connection, why, live }));
    this.link.dataset.connection = connection;
    write(this.link, text(`connection.state.${connection}`));
    if (!live) return;
    write(this.clock, `${day(live.t)} ${time(live.t, true)} ${zoneName(live.t)}`);
    this.clock.dateTime = new Date(live.t).toISOString();
    this.old(live.ageS);
    this.entitle(live.state);
  }

  showVerdict({ kind, icon: shape, headline, detail }) {
    const elsewhere = (this.model.view?.mode ?? "live") !== "live";
    this.verdict.dataset.kind = kind;
    if (this.mark.dataset.shape !== shape) this.mark.replaceChildren(icon(shape));
    this.mark.dataset.shape = shape;
    // The verdict is on the sea now, even while the reader looks at another.
    write(this.headline, elsewhere ? text("bar.verdictNow", { headline }) : headline);
    write(this.detail, detail);
    this.detail.title = detail;
  }

  old(age) {
    const limit = this.model.topology?.stale_after_s ?? Infinity;
    write(this.age, inputAge(age));
    this.age.dataset.old = age === null || age > limit / 2;
    this.age.title = Number.isFinite(limit)
      ? text("bar.patience", { span: span(limit) }) : "";
  }

  /** Say in the tab's title what would make somebody come back to it. */
  entitle({ alarms = [], valid, cage }) {
    const unseen = alarms.filter((alarm) => waits(alarm) && !alarm.acknowledged);
    const urgent = unseen.some((alarm) => rank(alarm.severity) === "critical") ? "! " : "";
    const count = unseen.length ? `(${urgent}${unseen.length}) ` : "";
    const title = `${count}${cage}${valid ? "" : text("bar.invalid")} · seacage`;
    if (document.title !== title) document.title = title;
  }
}
