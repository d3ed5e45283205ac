// Texts of the service in the reader's language: alarms and concerns by key, other sentences by
// how they read in English. Whatever the page does not know stays as it came.

import { capital, fixed, localDigits, percent, plain, span } from "./panels/format.js";
import { has, inEnglish, language, text } from "./texts/index.js";

const BY_UNIT = { share: percent, s: span };
const SPANS = { s: "seconds", min: "minutes", h: "hours", days: "days" };

/** A pattern of what an English text looks like once its values stand in it. */
function patternOf(template) {
  const escaped = template.replace(/[.?()|]/g, "\\$&");
  return new RegExp(`^${escaped.replace(/\{(\w+)\}/g, "(?<$1>.+?)")}(?=\\s|$)`);
}

const SENTENCES = inEnglish("service").map(([name, template]) => [name, patternOf(template)]);

/** Sentences of the service, one after the other. */
export function sentences(words) {
  if (!words || language === "en") return words;
  for (const [name, pattern] of SENTENCES) {
    const found = pattern.exec(words);
    if (found) {
      const values = Object.entries(found.groups ?? {}).map(([key, value]) => [key, valueIn(value)]);
      return [capital(text(`service.${name}`, Object.fromEntries(values))), sentences(words.slice(found[0].length).trim())]
        .filter(Boolean).join(" ");
    }
  }
  return words;
}

/** A value of such a sentence: a duration, a number, a word that has a text, or a name. */
function valueIn(value) {
  const [, count, unit] = /^([\d.]+) (s|min|h|days)$/.exec(value) ?? [];
  if (unit) return text(`span.${SPANS[unit]}`, { count: localDigits(count) });
  if (/^\d/.test(value)) return /^[\d.]+$/.test(value) ? localDigits(value) : value;
  return word(value);
}

/** A word of the service, such as an origin; a name where it is none that is known. */
export function word(value) {
  const key = value.replaceAll(" ", "-");
  return has(`word.${key}`) ? text(`word.${key}`) : plain(value);
}

/** The values of a key, written by the unit at the end of their names. */
function written(values) {
  return Object.fromEntries(Object.entries(values).flatMap(([name, value]) => {
    const words = shownValue(name, value);
    return [[name, words], [capital(name), capital(words)]];
  }));
}

function shownValue(name, value) {
  if (name === "detail") return sentences(value);
  if (Array.isArray(value)) return value.map(plain).join(", ");
  return typeof value === "string" ? plain(value) : (BY_UNIT[name.split("_").at(-1)] ?? fixed)(value);
}

/** An alarm with its texts. */
export function alarmIn(alarm) {
  const { key = "", values = {} } = alarm;
  const [kind, state] = key.split(".");
  if (!state || !has(`alarm.${key}`)) return alarm;
  const words = written(values);
  return {
    ...alarm, title: text(`alarm.${kind}.title`, words),
    message: [text(`alarm.${kind}.${state}`, words), words.detail].filter(Boolean).join(" "),
    ...(alarm.advice ? { advice: text(`alarm.${kind}.advice`) } : {}),
  };
}

/** What an alarm is called, by its name alone: `load.bridle-3`. */
export function alarmName(id) {
  const [kind, ...source] = id.split(".");
  return has(`alarm.${kind}.title`) ? text(`alarm.${kind}.title`, written({ source: source.join(".") })) : id;
}

function concernIn(concern) {
  const { key = "", values = {} } = concern;
  if (!has(`concern.${key}.title`)) return concern;
  const message = capital(text(`concern.${key}.message`, written(values)));
  return { ...concern, title: text(`concern.${key}.title`), message };
}

const withReason = (one) => ({ ...one, interval_reason: sentences(one.interval_reason) });

/** A state with all its texts. */
export function stateIn(state) {
  return {
    ...state, reason: sentences(state.reason), lines_reason: sentences(state.lines_reason),
    alarms: (state.alarms ?? []).map(alarmIn), concerns: (state.concerns ?? []).map(concernIn),
    bridles: state.bridles?.map(withReason), sensors: state.sensors?.map(withReason),
    shape: state.shape && withReason(state.shape),
  };
}

/** A cage of the farm with all its texts. */
export function cageIn(cage) {
  const worst = { key: cage.worst_key ?? "", values: cage.worst_values, title: cage.worst_title };
  return { ...cage, reason: sentences(cage.reason), worst_title: alarmIn(worst).title,
    concerns: (cage.concerns ?? []).map(concernIn) };
}
