// Texts of the page in the reader's language; docs/page.md says how to add one.

import en from "./en.js";

const LANGUAGES = { en };

/** The first of the browser's languages that has a file; English where none has. */
export const language = (globalThis.navigator?.languages ?? [])
  .map((tag) => tag.split("-")[0]).find((tag) => tag in LANGUAGES) ?? "en";

const plural = new Intl.PluralRules(language);
const find = (texts, key) => key.split(".").reduce((part, name) => part?.[name], texts);

/** The text of a key such as `farm.title`, with `values` for its placeholders. */
export function text(key, values = {}) {
  const found = find(LANGUAGES[language], key) ?? find(en, key);
  const chosen = typeof found === "string" ? found : found[plural.select(values.count)] ?? found.other;
  return chosen.replace(/\{(\w+)\}/g, (_, name) => values[name]);
}
