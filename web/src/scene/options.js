// What the reader chose to see, remembered by the browser.

import { Observable } from "../observable.js";

const KEY = "seacage-scene";
const FIRST = {
  view: "3d", // or "flat"
  tint: "plain", // or "moved", "sigma"
  ghost: true, shell: false, sea: true,
  scale: "viridis",
  locked: true, // the scale of the loads reaches to the capacity, else to the largest load
};

/** The options; listeners are called with the name of what changed. */
export class Options extends Observable {
  constructor() {
    super();
    let kept = {};
    try {
      kept = JSON.parse(localStorage.getItem(KEY)) ?? {};
    } catch {
      localStorage.removeItem(KEY); // not ours: begin anew
    }
    for (const name of Object.keys(FIRST)) {
      this[name] = typeof kept[name] === typeof FIRST[name] ? kept[name] : FIRST[name];
    }
  }

  set(name, value) {
    this[name] = value;
    const kept = Object.fromEntries(Object.keys(FIRST).map((one) => [one, this[one]]));
    localStorage.setItem(KEY, JSON.stringify(kept));
    this.notify(name);
  }
}
