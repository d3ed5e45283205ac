// Light or dark: as the system says, unless the reader chose.

const KEY = "seacage-theme";
const listeners = new Set();
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

/** Call `fn` whenever it changes. */
export function onTheme(fn) {
  listeners.add(fn);
  return () => listeners.delete(fn);
}

/** A colour or number of the style sheet. */
export const styled = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function apply() {
  document.documentElement.dataset.theme = theme();
  for (const fn of listeners) fn(theme());
}

light.addEventListener("change", apply);
apply();
