// The panels as tabs: one is seen, arrow keys go round.

import { make, still } from "../dom.js";
import { text } from "../texts/index.js";

export class Tabs {
  /** `all` are {name, key}, titled by the texts; `seen` is called with the name of the one shown. */
  constructor(holder, all, { label, seen = () => {} }) {
    this.seen = seen;
    this.parts = new Map(all.map((one) => [one.name, this.part(one)]));
    this.list = make("div", { className: "tabs", role: "tablist", ariaLabel: label },
      ...[...this.parts.values()].map(({ tab }) => tab));
    this.list.addEventListener("keydown", (event) => this.key(event));
    holder.append(this.list, ...[...this.parts.values()].map(({ panel }) => panel));
    this.show(all[0].name);
  }

  part({ name, key }) {
    const badge = make("span", { className: "tab-badge", hidden: true });
    const tab = make("button", {
      type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`,
      title: key ? text("tabs.key", { key }) : "", onclick: () => this.chosen(name),
    }, text(`tabs.title.${name}`), badge);
    const panel = make("div", {
      role: "tabpanel", id: `panel-${name}`, className: "tab-panel", "aria-labelledby": tab.id,
      tabIndex: 0, hidden: true,
    });
    return { tab, panel, badge };
  }

  panel(name) {
    return this.parts.get(name).panel;
  }

  /** Put a number on a tab, with what it counts; 0 takes it away. */
  badge(name, count, words, rank) {
    const { badge } = this.parts.get(name);
    badge.hidden = !count;
    badge.textContent = count ? String(count) : "";
    badge.ariaLabel = count ? `, ${words}` : "";
    badge.setAttribute("role", "img");
    badge.dataset.rank = rank ?? "";
  }

  /** On a phone the panel lies below what is seen: bring it up. */
  chosen(name) {
    this.show(name);
    if (matchMedia("(max-width: 860px)").matches) {
      this.panel(name).scrollIntoView({ block: "start", behavior: still() ? "auto" : "smooth" });
    }
  }

  show(name, { focus = false } = {}) {
    this.shown = name;
    for (const [one, { tab, panel }] of this.parts) {
      const chosen = one === name;
      tab.setAttribute("aria-selected", chosen);
      tab.tabIndex = chosen ? 0 : -1;
      panel.hidden = !chosen;
      if (chosen && focus) tab.focus();
    }
    this.seen(name);
  }

  key(event) {
    const names = [...this.parts.keys()];
    const at = names.indexOf(this.shown);
    const next = {
      ArrowRight: at + 1, ArrowLeft: at - 1 + names.length, Home: 0, End: names.length - 1,
    }[event.key];
    if (next === undefined) return;
    event.preventDefault();
    this.show(names[next % names.length], { focus: true });
  }
}
