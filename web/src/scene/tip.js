// The note beside what the reader points at.

import { make } from "../dom.js";

/** Show words at a place of the scene. */
export class Tip {
  constructor(holder) {
    this.holder = holder;
    this.element = make("div", { className: "scene-tip", role: "status", hidden: true });
    holder.append(this.element);
  }

  /** Words as of words.js at [x, y] px; null hides. */
  show(words, at) {
    this.element.hidden = !words || !at;
    if (this.element.hidden) return;
    const key = JSON.stringify(words);
    if (key !== this.key) {
      this.key = key;
      this.element.replaceChildren(make("h3", {}, words.title),
        make("dl", {}, ...words.rows.flatMap(([name, value]) =>
          [make("dt", {}, name), make("dd", {}, value)])),
        ...(words.note ? [make("p", {}, words.note)] : []));
    }
    const { clientWidth: width, clientHeight: height } = this.holder;
    const { offsetWidth: w, offsetHeight: h } = this.element;
    const x = at[0] + 18 + w > width - 8 ? Math.max(8, at[0] - 18 - w) : at[0] + 18;
    const y = Math.min(Math.max(8, at[1] - h / 2), Math.max(8, height - h - 8));
    this.element.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
  }
}
