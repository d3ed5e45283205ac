// The alarms, worst first, each with what can be done.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { actionsFor } from "./alarm-actions.js";
import { grouped, titleOf, unseen } from "./alarm-groups.js";
import { empty, write } from "./dom.js";
import { moment, unbroken } from "./format.js";
import { icon } from "./icons.js";
import { sourceOf } from "./load-rows.js";
import { ordered, rank, standing, waits } from "./ranks.js";
import { worth } from "./worth.js";

export class AlarmList {
  constructor(holder, model, desk, { ask }) {
    Object.assign(this, { model, desk, ask });
    this.denied = make("p", { className: "denied", hidden: true }, text("alarms.denied"));
    this.list = make("ol", { className: "alarms" });
    this.none = make("div");
    holder.append(this.denied, this.none, this.list);
    desk.on(() => this.show());
    this.show();
  }

  show() {
    const { alarms, fault, denied } = this.desk;
    // Made anew only where something changed, so that nobody's button goes from under a finger.
    const seen = JSON.stringify([alarms, fault, denied]);
    if (seen === this.seen) return;
    this.seen = seen;
    this.denied.hidden = !denied;
    const listed = (alarms ?? []).filter((alarm) =>
      alarm.active || !alarm.acknowledged || alarm.shelved || alarm.in_service === false);
    this.none.replaceChildren(...nothing(alarms, listed, fault));
    const kept = document.activeElement?.dataset?.act;
    this.list.replaceChildren(...grouped(ordered(listed)).map((group) => this.group(group)));
    // The list is made anew; whoever stood on a button still stands there.
    if (kept) this.list.querySelector(`[data-act="${CSS.escape(kept)}"]`)?.focus();
  }

  /** Alarms of one cause under one heading; one alone as it is. */
  group(group) {
    if (group.length === 1) return this.item(group[0]);
    const [first] = group;
    const how = rank(Math.max(...group.map(({ severity }) => severity)));
    const title = titleOf(group);
    const ids = unseen(group).map(({ id }) => id);
    const item = make("li", { className: "alarm-group" },
      make("header", {}, make("span", { className: "alarm-mark" }, icon(how)),
        make("div", { className: "alarm-words" }, make("h3", {}, title),
          make("p", { className: "alarm-standing" }, together(group))),
        ...(ids.length ? [this.button({ id: `group.${first.id}`, title }, "acknowledge",
          { ids, title }, 
          ids.length === group.length ? text("alarms.all") : text("alarms.some", { count: ids.length }))] : [])),
      make("ol", { className: "alarms" }, ...group.map((alarm) => this.item(alarm))));
    item.dataset.rank = waits(first) ? how : "quiet";
    return item;
  }

  item(alarm) {
    const how = rank(alarm.severity);
    const words = make("div", { className: "alarm-words" },
      make("h3", {}, alarm.title),
      make("p", { className: "alarm-standing" }, unbroken(facts(alarm))),
      make("p", { className: "alarm-message" }, unbroken(alarm.message)),
      ...[alarm.advice, alarm.comment && `“${alarm.comment}”`].filter(Boolean)
        .map((more) => make("p", { className: "alarm-more" }, more)));
    const buttons = make("div", { className: "alarm-buttons" },
      ...actionsFor(alarm).map((name) => this.button(alarm, name)), ...this.pointer(alarm));
    const item = make("li", { className: "alarm" },
      make("span", { className: "alarm-mark" }, icon(how), make("span", { className: "unseen" }, text(`rank.${how}`))),
      words, buttons);
    item.dataset.rank = waits(alarm) ? how : "quiet";
    item.dataset.seen = alarm.acknowledged;
    return item;
  }

  button(alarm, name, group = null, word = text(`actions.${name}.word`)) {
    const main = name === "acknowledge" ? " main" : "";
    const button = make("button", {
      type: "button", className: `button small${main}`,
      ariaLabel: text("alarms.button", { action: word, title: alarm.title }),
      onclick: () => (this.desk.denied ? this.refuse() : this.ask(alarm, name, group)),
    }, word);
    button.dataset.act = `${alarm.id} ${name}`;
    if (this.desk.denied) {
      button.ariaDisabled = "true";
      button.title = this.denied.textContent;
    }
    return button;
  }

  refuse() {
    this.denied.setAttribute("role", "alert");
    const words = this.denied.textContent;
    write(this.denied, "");
    write(this.denied, words);
  }

  /** A way to where the alarm is about, if that is drawn. */
  pointer({ id, title }) {
    const source = sourceOf(id);
    const { topology } = this.model;
    const there = topology?.bridle_names.includes(source) ? { bridle: source }
      : [...(topology?.depth_sensors ?? []), ...(topology?.shackles ?? [])]
        .some(({ name }) => name === source) ? { sensor: source } : null;
    if (!there) return [];
    return [make("button", {
      type: "button", className: "button small quiet", ariaLabel: text("alarms.showOnNet", { title }),
      onclick: () => this.model.select(there),
    }, text("alarms.show"))];
  }
}

/** Since when a group is there, and how it stands. */
function together(group) {
  const since = Math.min(...group.map((alarm) => Date.parse(alarm.since)).filter(Number.isFinite));
  const open = unseen(group).length;
  const state = group[0].active ? text("alarms.active") : text("alarms.cleared");
  return unbroken([
    open ? text("alarms.unacknowledged", { state, count: open }) : text("alarms.allAcknowledged", { state }),
    ...(Number.isFinite(since) ? [text("alarms.since", { moment: moment(since) })] : []),
  ].join(" · "));
}

function facts(alarm) {
  const at = (t) => ({ moment: moment(Date.parse(t)) });
  const state = standing(alarm);
  return [
    alarm.shelved_until ? text("alarms.until", { state, ...at(alarm.shelved_until) }) : state,
    alarm.since && text("alarms.since", at(alarm.since)), worth(alarm.id, alarm.value),
  ].filter(Boolean).join(" · ");
}

function nothing(alarms, listed, fault) {
  if (fault) return [empty(text("alarms.failed"), fault)];
  if (!alarms) return [empty(text("alarms.loading"), text("alarms.asking"))];
  if (listed.length) return [];
  const calm = empty(text("alarms.none"), text("alarms.calm"));
  calm.prepend(icon("well"));
  return [calm];
}
