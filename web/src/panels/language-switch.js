// The choice of the page's language.

import { make } from "../dom.js";
import { LANGUAGES, language, speak, text } from "../texts/index.js";

/** Make it: a code that covers a list of languages, each in its own words. */
export function languageSwitch() {
  const select = make("select", { ariaLabel: text("bar.language"), title: text("bar.language") },
    ...Object.entries(LANGUAGES).map(([tag, [name]]) =>
      make("option", { value: tag, lang: tag, selected: tag === language }, name)));
  select.addEventListener("change", () => speak(select.value));
  return make("label", { className: "round language" },
    make("span", { ariaHidden: "true" }, language.toUpperCase()), select);
}
