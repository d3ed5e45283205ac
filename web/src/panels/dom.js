// What the panels need besides making elements.

import { make } from "../dom.js";

/** Write a text only where it differs: an unchanged one is not read aloud again. */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Wrap a function so that it runs at most once between two pictures of the screen. */
export function painted(paint) {
  let requested = false;
  return () => {
    if (requested) return;
    requested = true;
    requestAnimationFrame(() => {
      requested = false;
      paint();
    });
  };
}

/** A legend: what each mark stands for. */
export function explain(marks) {
  return make("ul", { className: "legend" }, ...Object.entries(marks).map(([mark, words]) =>
    make("li", {}, make("span", { className: `mark ${mark}`, ariaHidden: "true" }), words)));
}

/** What is shown where there is nothing to show: why, and what would change it. */
export function empty(headline, words) {
  return make("div", { className: "empty" }, make("p", { className: "empty-head" }, headline),
    make("p", {}, words));
}
