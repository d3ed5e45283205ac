// Small drawings that say with a shape what a colour says too.

import { draw } from "../dom.js";

const SHAPES = {
  well: ["M12 2.5a9.5 9.5 0 1 1 0 19 9.5 9.5 0 0 1 0-19Z", "m7.5 12.4 3.1 3.1 6-6.6"],
  warning: ["M12 3 22 20.5H2L12 3Z", "M12 9.5v5", "M12 17.4v.2"],
  critical: ["M8 2.5h8L21.5 8v8L16 21.5H8L2.5 16V8L8 2.5Z", "M12 7v6", "M12 16.6v.2"],
  note: ["M12 2.5a9.5 9.5 0 1 1 0 19 9.5 9.5 0 0 1 0-19Z", "M12 11v6", "M12 7.2v.2"],
  none: ["M12 2.5a9.5 9.5 0 1 1 0 19 9.5 9.5 0 0 1 0-19Z", "m5.5 18.5 13-13"],
  beyond: ["M3 21V3", "M3 12h16", "m13.5 6.5 5.5 5.5-5.5 5.5"],
  lost: ["M12 21v-4", "M3.5 9a12.5 12.5 0 0 1 17 0", "M7.3 13a7 7 0 0 1 9.4 0", "m4 3 16 16"],
  wait: ["M12 2.5a9.5 9.5 0 1 1 0 19 9.5 9.5 0 0 1 0-19Z", "M12 6.5V12l3.5 2.5"],
  past: ["M3.5 4.5v5h5", "M4 9.5a9 9 0 1 1-.9 4.5", "M12 7.5V12l3.2 2"],
  whatif: ["M4 7h9", "M17 7h3", "M15 4.5v5", "M4 17h3", "M11 17h9", "M9 14.5v5"],
  farm: ["M7.5 4a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7Z", "M16.5 4a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7Z",
    "M12 13.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7Z"],
  sun: ["M12 8a4 4 0 1 1 0 8 4 4 0 0 1 0-8Z", "M12 2v2.5M12 19.5V22M2 12h2.5M19.5 12H22M4.9 4.9l1.8 1.8M17.3 17.3l1.8 1.8M19.1 4.9l-1.8 1.8M6.7 17.3l-1.8 1.8"],
  moon: ["M20 14.5A8.5 8.5 0 0 1 9.5 4a8.5 8.5 0 1 0 10.5 10.5Z"],
  auto: ["M12 2.5a9.5 9.5 0 1 1 0 19 9.5 9.5 0 0 1 0-19Z", "M12 3v18M12 8l6.5-1.5M12 13l8.5-2M12 18l6.5-2"],
  help: ["M12 2.5a9.5 9.5 0 1 1 0 19 9.5 9.5 0 0 1 0-19Z", "M9.2 9.3a2.9 2.9 0 1 1 4.2 2.6c-.9.4-1.4 1-1.4 2", "M12 17.3v.2"],
  play: ["M7 4.5v15l12-7.5-12-7.5Z"],
  pause: ["M8 5v14M16 5v14"],
  live: ["M12 10.5a1.5 1.5 0 1 1 0 3 1.5 1.5 0 0 1 0-3Z", "M8 8a5.7 5.7 0 0 0 0 8M16 8a5.7 5.7 0 0 1 0 8M5 5a10 10 0 0 0 0 14M19 5a10 10 0 0 1 0 14"],
  close: ["m6 6 12 12M18 6 6 18"],
  sound: ["M4 9.5v5h3.5L12 18.5v-13L7.5 9.5H4Z", "M15.5 9a4.2 4.2 0 0 1 0 6M18 6.5a8 8 0 0 1 0 11"],
  mute: ["M4 9.5v5h3.5L12 18.5v-13L7.5 9.5H4Z", "m16 9.5 5 5M21 9.5l-5 5"],
  arrow: ["M12 3v18", "m6 9 6-6 6 6"],
  wave: ["M2 9c2.5-3 4.5-3 6.7 0s4.2 3 6.6 0 4.2-3 6.7 0", "M2 16c2.5-3 4.5-3 6.7 0s4.2 3 6.6 0 4.2-3 6.7 0"],
};

/** Draw an icon; it says nothing to a screen reader, for which the words beside it are. */
export function icon(name) {
  return draw("svg", { viewBox: "0 0 24 24", class: `icon icon-${name}`, "aria-hidden": "true" },
    ...SHAPES[name].map((d) => draw("path", { d })));
}

/** The icon of an alarm's rank. */
export const rankIcon = (rank) => icon(rank === "critical" || rank === "warning" ? rank : "note");
