// A button that goes from light to dark and back.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { onTheme, setTheme, theme } from "../theme.js";
import { icon } from "./icons.js";

/** Take the other theme, and keep it for the next visit. */
export const otherTheme = () => setTheme(theme() === "dark" ? "light" : "dark");

/** Make the button. */
export function themeSwitch() {
  const button = make("button", { className: "round", type: "button", onclick: otherTheme });
  const show = () => {
    const other = theme() === "dark" ? "light" : "dark";
    button.replaceChildren(icon(other === "light" ? "sun" : "moon"));
    button.ariaLabel = text(`bar.theme.${other}`);
    button.title = `${button.ariaLabel} (T)`;
  };
  onTheme(show);
  show();
  return button;
}
