// From one shape of the net to the next, smoothly.

import { still } from "../dom.js";

const LONGEST_MS = 1500;
const SHORTEST_MS = 120;

/** Holds what is shown, and moves it towards what is so. */
export class Glide {
  constructor(rest) {
    this.rest = rest;
    this.position = Float32Array.from(rest);
    this.sigma = null;
    this.ends = 0;
    this.came = 0;
  }

  /** Take a new shape; null positions mean still water. */
  aim(position, sigma, now) {
    // A shape is reached about when the next one comes.
    const every = Math.min(LONGEST_MS, Math.max(SHORTEST_MS, now - this.came));
    const first = this.came === 0;
    this.from = Float32Array.from(this.position);
    this.to = position ?? this.rest;
    this.sigma = sigma;
    this.came = now;
    this.starts = now;
    this.ends = first || still() ? now : now + every;
  }

  /** Move on; whether there is more to come. */
  step(now) {
    if (!this.to) return false;
    const share = now >= this.ends ? 1 : (now - this.starts) / (this.ends - this.starts);
    for (let k = 0; k < this.position.length; k += 1) {
      this.position[k] = this.from[k] + share * (this.to[k] - this.from[k]);
    }
    return share < 1;
  }
}
