// The first line: what an operator has to know in three seconds.

import { beyond, counted, moment, plain, span } from "./format.js";
import { rank, waits, worst } from "./ranks.js";

/**
 * One judgement on the whole: {kind, icon, headline, detail}.
 *
 * Worst first: no connection, then no valid input, then alarms, then an answer beyond what was
 * learned. Nothing is well without an input that says so.
 */
export function judged({ connection, why = "", live }) {
  const state = live?.state;
  if (connection === "lost") {
    const shown = state ? `What is shown is of ${moment(live.t)}.` : why || "Nothing has come yet.";
    return said("lost", "lost", "Connection lost", shown);
  }
  if (connection === "asking") return said("none", "wait", "Waiting for a token", "");
  if (connection === "refused") return said("lost", "none", "Not admitted", why);
  if (!state || connection === "connecting") {
    return said("none", "wait", "Connecting", "Asking for the newest state.");
  }
  if (live.stale && state.valid) {
    return said("lost", "lost", "Input too old", `The newest reading is ${span(live.ageS)} old.`);
  }
  return state.valid ? ofLoads(state) : withoutInput(state);
}

function ofLoads(state) {
  const alarms = (state.alarms ?? []).filter(waits);
  const first = worst(alarms);
  if (first) {
    const kind = rank(first.severity);
    const more = alarms.length > 1 ? ` and ${alarms.length - 1} more` : "";
    const over = first.active ? "" : ", over by now";
    const told = state.in_domain || first.id.startsWith("domain.");
    const extra = told ? "" : " The twin is extrapolating.";
    return said(kind, kind, counted(alarms.length, "alarm"), `${first.title}${over}${more}.${extra}`);
  }
  if (!state.in_domain) {
    return said("beyond", "beyond", "Extrapolating", beyond(state.reason));
  }
  const silent = (state.silent ?? []).map(plain);
  return said("well", "well", "All well",
    silent.length ? `But silent: ${silent.join(", ")}.` : "Loads and net within their limits.");
}

function withoutInput(state) {
  const alarms = (state.alarms ?? []).filter(waits);
  const also = alarms.length ? ` ${counted(alarms.length, "alarm")}.` : "";
  if (state.age_s === null) {
    return said("none", "wait", "Waiting for a first reading", `No loads are shown.${also}`);
  }
  const first = worst(alarms);
  return said(first ? rank(first.severity) : "none", "none", "No valid input",
    `${state.reason || "The newest reading is not usable."} No loads are shown.${also}`);
}

const said = (kind, icon, headline, detail) => ({ kind, icon, headline, detail });
