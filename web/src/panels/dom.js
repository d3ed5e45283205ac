// What the panels need besides making elements.

import { make } from "../dom.js";
import { text } from "../texts/index.js";
import { icon } from "./icons.js";

/** Write a text only where it differs: an unchanged one is not read aloud again. */
export function write(element, words) {
  if (element.textContent !== words) element.textContent = words;
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

/** A legend: each mark with the name of what it shows, as a key below `mark`. */
export function explain(marks) {
  return make("ul", { className: "legend" }, ...Object.entries(marks).map(([mark, name]) =>
    make("li", {}, make("span", { className: `mark ${mark}`, ariaHidden: "true" }), text(`mark.${name}`))));
}

/** A button that closes what it stands in. */
export const closeButton = (onclick) =>
  make("button", { type: "button", className: "round", ariaLabel: text("page.close"), onclick }, icon("close"));

/** The head of a table, column by column. */
export const tableHead = (heads) =>
  make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head))));

/** What is shown where there is nothing to show: why, and what would change it. */
export function empty(headline, words) {
  return make("div", { className: "empty" }, make("p", { className: "empty-head" }, headline),
    make("p", {}, words));
}
