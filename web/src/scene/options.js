// What the reader chose to see, remembered by the browser.

const KEY = "seacage-scene";
const FIRST = {
  view: "3d", // or "flat"
  tint: "plain", // or "moved", "sigma"
  ghost: true, shell: false, sea: true,
  scale: "viridis",
  locked: true, // the scale of the loads reaches to the capacity, else to the largest load
};

/** The options, and who listens to them. */
export class Options {
  constructor() {
    this.listeners = new Set();
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

  /** Call `fn` with the name of what changed; the answer stops it. */
  on(fn) {
    this.listeners.add(fn);
    return () => this.listeners.delete(fn);
  }

  set(name, value) {
    this[name] = value;
    const kept = Object.fromEntries(Object.keys(FIRST).map((one) => [one, this[one]]));
    localStorage.setItem(KEY, JSON.stringify(kept));
    for (const fn of this.listeners) fn(name);
  }
}
