// What the net says, beside it: the top line, the panels, the time below, and the dialogs.

import "uplot/dist/uPlot.min.css";
import "./panels.css";

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { onUnits, setSiteZone } from "../units.js";
import { AlarmDesk } from "./alarm-desk.js";
import { Alarms } from "./alarms.js";
import { Banner } from "./banner.js";
import { Bar } from "./bar.js";
import { Charts } from "./charts.js";
import { Farm } from "./farm.js";
import { Help } from "./help.js";
import { LineCard } from "./line-card.js";
import { Loads } from "./loads.js";
import { Now } from "./now.js";
import { Parting } from "./parting.js";
import { Past } from "./past.js";
import { rank, worst } from "./ranks.js";
import { listenForKeys } from "./shortcuts.js";
import { Tabs } from "./tabs.js";
import { otherTheme } from "./theme-switch.js";
import { Timeline } from "./timeline.js";
import { Toasts } from "./toasts.js";
import { UnitsDialog } from "./units-dialog.js";
import { WhatIf } from "./whatif.js";

const TABS = ["loads", "charts", "alarms", "whatif"].map((name, k) => ({ name, key: k + 1 }));

/** Fill the regions around the scene. */
export function mountPanels(model) {
  const region = (id) => document.getElementById(id);
  const [past, desk, farm, help, units] =
    [new Past(model), new AlarmDesk(model), new Farm(model), new Help(), new UnitsDialog()];
  model.on("topology", ({ time_zone: zone }) => setSiteZone(zone));
  const bar = make("div", { className: "bar-line" });
  region("bar").append(bar);
  new Bar(bar, model, { openFarm: () => farm.open(), openHelp: () => help.open(), openUnits: () => units.open() });
  new Banner(region("bar"), model);

  const now = make("section", { className: "now", ariaLabel: text("now.title") });
  region("panels").append(now);
  new Now(now, model);
  const parting = new Parting(model);
  const parts = {};
  const tabs = new Tabs(region("panels"), TABS, {
    label: text("tabs.label"),
    seen: (shown) => Object.entries(parts).forEach(([name, part]) => part.visible?.(name === shown)),
  });
  Object.assign(parts, {
    loads: new Loads(tabs.panel("loads"), model, parting),
    charts: new Charts(tabs.panel("charts"), model, past),
    alarms: new Alarms(tabs.panel("alarms"), model, desk, past),
    whatif: new WhatIf(tabs.panel("whatif"), model),
  });
  new LineCard(region("scene"), model, parting);
  desk.on(() => {
    const first = worst(desk.waiting);
    const count = desk.waiting.length;
    tabs.badge("alarms", count, text("count.alarms", { count }), first && rank(first.severity));
  });
  new Toasts(model, { look: () => tabs.show("alarms", { focus: true }) });
  const timeline = new Timeline(region("timeline"), model, past, desk);
  onUnits(() => {
    model.refresh();
    for (const one of [past, desk]) one.notify();
  });
  listenForKeys({
    ...Object.fromEntries(TABS.map(({ name, key }) => [key, () => tabs.show(name, { focus: true })])),
    l: () => timeline.live(), " ": () => timeline.play(), ",": () => timeline.step(-1),
    ".": () => timeline.step(1), f: () => farm.open(), t: otherTheme, u: () => units.open(), "?": () => help.open(),
    v: () => model.options.set("view", model.options.view === "flat" ? "3d" : "flat"),
    Escape: () => model.select(null),
  });
}
