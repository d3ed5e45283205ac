// Light or dark: as the system says, unless the reader chose.

import { Observable } from "./observable.js";

const KEY = "seacage-theme";
const themes = new Observable();
const light = matchMedia("(prefers-color-scheme: light)");

/** "light" or "dark", as shown. */
export const theme = () =>
  localStorage.getItem(KEY) ?? (light.matches ? "light" : "dark");

/** Choose one; null follows the system again. */
export function setTheme(chosen) {
  if (chosen) localStorage.setItem(KEY, chosen);
  else localStorage.removeItem(KEY);
  apply();
}

/** Call `fn` whenever it changes; the answer stops it. */
export const onTheme = (fn) => themes.on(fn);

/** A colour or number of the style sheet. */
export const styled = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function apply() {
  document.documentElement.dataset.theme = theme();
  themes.notify(theme());
}

light.addEventListener("change", apply);
apply();
