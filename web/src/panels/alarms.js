// The alarms in three tabs: those there are, their journal and their key figures.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { AlarmDialog } from "./alarm-dialog.js";
import { AlarmList } from "./alarm-list.js";
import { Journal } from "./journal.js";
import { Kpi } from "./kpi.js";
import { soundSwitch } from "./sound.js";
import { Tabs } from "./tabs.js";

export class Alarms {
  constructor(holder, model, desk, past) {
    const views = [{ name: "alarm-list" }, { name: "journal" }, { name: "kpi" }];
    const tabs = new Tabs(holder, views, { label: text("tabs.title.alarms"), seen: () => this.refresh() });
    tabs.list.classList.add("minor");
    const dialog = new AlarmDialog(desk);
    new AlarmList(tabs.panel("alarm-list"), model, desk, { ask: (...question) => dialog.ask(...question) });
    tabs.panel("alarm-list").append(make("p", { className: "aside sound-line" }, soundSwitch()));
    this.parts = {
      journal: new Journal(tabs.panel("journal"), model, desk, past),
      kpi: new Kpi(tabs.panel("kpi"), desk, past),
    };
    this.tabs = tabs;
    desk.on(() => this.refresh());
  }

  /** Ask again for what is looked at, where somebody looks. */
  visible(shown) {
    this.shown = shown;
    this.refresh();
  }

  refresh() {
    if (this.shown) this.parts[this.tabs?.shown]?.show();
  }
}
