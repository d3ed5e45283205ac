// One chart over the whole width; Escape puts it back.

import { make } from "../dom.js";
import { text } from "../texts/index.js";

const SHARE = 0.62; // of the window's height

export class ChartDialog {
  /** `closed` is called when the chart is to be put back. */
  constructor({ closed }) {
    this.dialog = make("dialog", { className: "sheet whole", ariaLabel: text("charts.enlarged") });
    this.dialog.addEventListener("close", () => {
      const { chart } = this;
      this.chart = null;
      chart.grow(null);
      closed();
      chart.larger.focus();
    });
    document.body.append(this.dialog);
  }

  /** Enlarge a chart, or put it back where it is large already. */
  turn(chart) {
    if (this.chart) return this.close();
    this.chart = chart;
    this.dialog.replaceChildren(chart.card);
    this.dialog.showModal();
    return chart.grow(Math.round(SHARE * innerHeight));
  }

  close() {
    if (this.dialog.open) this.dialog.close();
  }
}
