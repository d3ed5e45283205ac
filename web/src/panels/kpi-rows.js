// What is counted of each alarm, in one row.

import { text } from "../texts/index.js";

/** Rows of the service's counts, the alarm that was raised most often first. */
export function kpiRows({ raised, standing, longest_s: longest, chattering }) {
  const names = [...new Set([raised, longest, standing].flatMap(Object.keys))];
  return names.map((name) => ({
    name, raised: raised[name] ?? 0, longestS: longest[name] ?? null,
    state: [name in standing && text("kpi.standing"), chattering.includes(name) && text("kpi.chattering")]
      .filter(Boolean).join(", ") || text("kpi.over"),
  })).sort((a, b) => b.raised - a.raised || (b.longestS ?? 0) - (a.longestS ?? 0));
}
