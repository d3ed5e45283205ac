// All about alarms: those that are, what was done, and how well they do.

import { make } from "../dom.js";
import { AlarmDialog } from "./alarm-dialog.js";
import { AlarmList } from "./alarm-list.js";
import { Journal } from "./journal.js";
import { Kpi } from "./kpi.js";
import { soundSwitch } from "./sound.js";
import { Tabs } from "./tabs.js";

export class Alarms {
  constructor(holder, model, desk, past) {
    const views = [
      { name: "alarm-list", title: "Now" }, { name: "journal", title: "Journal" },
      { name: "kpi", title: "Key figures" },
    ];
    const tabs = new Tabs(holder, views, { label: "Alarms", seen: () => this.refresh() });
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
