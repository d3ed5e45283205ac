// The verdict of the first line, to be read in three seconds.

import { text } from "../texts/index.js";
import { grouped, titleOf } from "./alarm-groups.js";
import { beyond, moment, plain, span } from "./format.js";
import { rank, waits, worst } from "./ranks.js";

/**
 * One verdict on the whole: {kind, icon, headline, detail}.
 *
 * Worst first: no connection, then no valid input, then alarms, then what the service is concerned
 * about and an answer beyond what was learned. Nothing is well without an input that says so.
 */
export function verdict({ connection, why = "", live }) {
  const state = live?.state;
  if (connection === "lost") {
    const shown = state ? text("verdict.shown", { moment: moment(live.t) }) : why || text("verdict.nothingYet");
    return result("lost", "lost", text("verdict.lost"), shown);
  }
  if (connection === "asking") return result("none", "wait", text("connection.state.asking"), "");
  if (connection === "refused") return result("lost", "none", text("connection.state.refused"), why);
  if (!state || connection === "connecting") {
    return result("none", "wait", text("connection.state.connecting"), text("verdict.newest"));
  }
  if (live.stale && state.valid) {
    return result("lost", "lost", text("verdict.old"), text("verdict.age", { age: span(live.ageS) }));
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
    const detail = text("verdict.worst", {
      title: titleOf(group), over: first.active ? "" : text("verdict.over"),
      more: others ? text("verdict.more", { count: others }) : "",
    });
    const named = state.in_domain || first.id.startsWith("domain.");
    return result(kind, kind, counted(alarms), named ? detail : `${detail} ${text("verdict.extrapolating")}`);
  }
  return concerned(state) ?? result("well", "well", text("verdict.well"), text("verdict.within"));
}

/** What keeps a cage without alarms from being well; null where nothing does. */
export function concerned({ in_domain: within, reason, concerns = [], silent = [] }) {
  const [load] = concerns.filter(({ kind }) => kind === "load");
  const messages = concerns.map(({ message }) => message);
  // A load at its limit has the colour of the alarm that it will raise.
  if (load) return result("warning", "warning", load.title, messages.join(" "));
  if (!within) return result("beyond", "beyond", text("verdict.beyond"), [beyond(reason), ...messages].join(" "));
  if (messages.length) return result("caution", "caution", concerns[0].title, messages.join(" "));
  if (silent.length) {
    return result("caution", "caution", text("verdict.partly"),
      text("verdict.silent", { names: silent.map(plain).join(", ") }));
  }
  return null;
}

function withoutInput(state) {
  const alarms = (state.alarms ?? []).filter(waits);
  const rest = [text("verdict.nothing"), ...(alarms.length ? [`${counted(alarms)}.`] : [])];
  if (state.age_s === null) return result("none", "wait", text("verdict.waiting"), rest.join(" "));
  const first = worst(alarms);
  const load = (state.concerns ?? []).find(({ kind }) => kind === "load");
  const kind = first ? rank(first.severity) : load ? "warning" : "none";
  const measured = load ? [load.message] : [];
  return result(kind, "none", text("verdict.invalid"),
    [...measured, state.reason || text("verdict.unusable"), ...rest].join(" "));
}

const counted = ({ length: count }) => text("count.alarms", { count });

const result = (kind, icon, headline, detail) => ({ kind, icon, headline, detail });
