// The first line: what an operator has to know in three seconds.

import { grouped, titleOf } from "./alarm-groups.js";
import { beyond, counted, moment, plain, span, titled } from "./format.js";
import { rank, waits, worst } from "./ranks.js";

/**
 * One judgement on the whole: {kind, icon, headline, detail}.
 *
 * Worst first: no connection, then no valid input, then alarms, then what the service is concerned
 * about and an answer beyond what was learned. Nothing is well without an input that says so.
 */
export function verdict({ connection, why = "", live }) {
  const state = live?.state;
  if (connection === "lost") {
    const shown = state ? `What is shown is of ${moment(live.t)}.` : why || "Nothing has come yet.";
    return result("lost", "lost", "Connection lost", shown);
  }
  if (connection === "asking") return result("none", "wait", "Waiting for a token", "");
  if (connection === "refused") return result("lost", "none", "Not admitted", why);
  if (!state || connection === "connecting") {
    return result("none", "wait", "Connecting", "Asking for the newest state.");
  }
  if (live.stale && state.valid) {
    return result("lost", "lost", "Input too old", `The newest reading is ${span(live.ageS)} old.`);
  }
  return state.valid ? ofLoads(state) : withoutInput(state);
}

function ofLoads(state) {
  const alarms = (state.alarms ?? []).filter(waits);
  const first = worst(alarms);
  if (first) {
    const kind = rank(first.severity);
    const group = grouped(alarms).find((one) => one.includes(first));
    const others = alarms.length - group.length;
    const more = others ? ` and ${others} more` : "";
    const over = first.active ? "" : ", over by now";
    const named = state.in_domain || first.id.startsWith("domain.");
    const extra = named ? "" : " The twin is extrapolating.";
    return result(kind, kind, counted(alarms.length, "alarm"), `${titleOf(group)}${over}${more}.${extra}`);
  }
  return concerned(state) ?? result("well", "well", "All well", "Loads and net within their limits.");
}

/** What keeps a cage without alarms from being well; null where nothing does. */
export function concerned({ in_domain: within, reason, concerns = [], silent = [] }) {
  const [load] = concerns.filter(({ kind }) => kind === "load");
  const messages = concerns.map(({ message }) => titled(message));
  // A load at its limit has the colour of the alarm that it will raise.
  if (load) return result("warning", "warning", load.title, messages.join(" "));
  if (!within) return result("beyond", "beyond", "Extrapolating", [beyond(reason), ...messages].join(" "));
  if (messages.length) return result("caution", "caution", concerns[0].title, messages.join(" "));
  if (silent.length) {
    return result("caution", "caution", "Partly measured", `Silent: ${silent.map(plain).join(", ")}.`);
  }
  return null;
}

function withoutInput(state) {
  const alarms = (state.alarms ?? []).filter(waits);
  const also = alarms.length ? ` ${counted(alarms.length, "alarm")}.` : "";
  if (state.age_s === null) {
    return result("none", "wait", "Waiting for a first reading", `Nothing is predicted.${also}`);
  }
  const first = worst(alarms);
  const load = (state.concerns ?? []).find(({ kind }) => kind === "load");
  const kind = first ? rank(first.severity) : load ? "warning" : "none";
  const measured = load ? `${titled(load.message)} ` : "";
  return result(kind, "none", "No valid input",
    `${measured}${state.reason || "The newest reading is not usable."} Nothing is predicted.${also}`);
}

const result = (kind, icon, headline, detail) => ({ kind, icon, headline, detail });
