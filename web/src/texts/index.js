// Texts of the page in the reader's language; docs/page.md says how to add one.

import en from "./en.js";

/** By tag, what each language calls itself and how its texts come; a reader loads one beside English. */
export const LANGUAGES = { en: ["English"], nb: ["Norsk bokmål", () => import("./nb.js")] };

const KEY = "seacage-language";
const NEAR = { no: "nb", nn: "nb" }; // whoever reads one reads the other
const ways = [globalThis.localStorage?.getItem(KEY), ...(globalThis.navigator?.languages ?? [])];

/** The one that the reader chose, else the first of the browser's that has a file, else English. */
export const language = ways.map((tag) => tag?.split("-")[0]).map((tag) => NEAR[tag] ?? tag)
  .find((tag) => Object.hasOwn(LANGUAGES, tag)) ?? "en";

const [, load] = LANGUAGES[language];
const own = load ? (await load()).default : en;
const plural = new Intl.PluralRules(language);
const find = (texts, key) => key.split(".").reduce((part, name) => (Object.hasOwn(part ?? {}, name) ? part[name] : undefined), texts);

/** Show everything in another language, for this visit and the next. */
export function speak(tag) {
  localStorage.setItem(KEY, tag);
  location.reload();
}

/** Whether there is a text of a key, in English at least. */
export const has = (key) => find(en, key) !== undefined;

/** The text of a key such as `farm.title`, with `values` for its placeholders. */
export function text(key, values = {}) {
  const found = find(own, key) ?? find(en, key);
  const chosen = typeof found === "string" ? found : found[plural.select(values.count)] ?? found.other;
  return chosen.replace(/\{(\w+)\}/g, (_, name) => values[name]);
}

/** The English texts below a key: [[name, text]]. */
export const inEnglish = (key) => Object.entries(find(en, key));
