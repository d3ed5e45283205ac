// The buttons over the scene: from where, what and in which colours.

import { draw, make } from "../dom.js";
import { onTheme, theme } from "../theme.js";
import { gradient } from "./colours.js";
import { loadEnd, tintOf } from "./paint.js";
import { noSpread } from "./words.js";

const SIDES = { oblique: "Oblique", side: "Side", top: "Top" };
const TINTS = { plain: "Net: plain", moved: "Net: movement", sigma: "Net: uncertainty" };
const TOGGLES = {
  ghost: ["Still water", "Show how the net hangs in still water"],
  shell: ["±2σ", "Show where the net may be: plus and minus two sigma"],
  sea: ["Surface", "Show the sea’s surface"],
};

/** Add them; `look` turns to a named side, in three dimensions. */
export function mountControls(model, options, holder, { look, flatOnly }) {
  const pressed = new Map();
  const button = (name, words, title, does) => {
    const made = make("button", { type: "button", title }, words);
    made.addEventListener("click", does);
    pressed.set(name, made);
    return made;
  };
  const sides = Object.entries(SIDES).map(([name, words]) =>
    button(name, words, "Look from this side", () => look(name)));
  const flat = button("flat", "2-D", "Draw flat, from the side and from above (V)", () =>
    options.set("view", options.view === "flat" ? "3d" : "flat"));
  const toggles = Object.entries(TOGGLES).map(([name, [words, title]]) =>
    button(name, words, title, () =>
      pressed.get(name).ariaDisabled !== "true" && options.set(name, !options[name])));
  const tint = make("select", {
    title: "What the net’s colour says", "aria-label": "Colour of the net",
  }, ...Object.entries(TINTS).map(([value, words]) => make("option", { value }, words)));
  tint.addEventListener("change", () => options.set("tint", tint.value));

  const show = () => {
    const isFlat = flatOnly || options.view === "flat";
    for (const name of Object.keys(TOGGLES)) pressed.get(name).ariaPressed = String(options[name]);
    flat.ariaPressed = String(isFlat);
    for (const one of [pressed.get("sea"), tint]) one.hidden = isFlat;
    tint.value = options.tint;
  };
  /** Where no spread is known there is no shell to show; the button says why. */
  const spread = () => {
    const { view } = model;
    const without = Boolean(view?.position && !view.sigma);
    const shell = pressed.get("shell");
    shell.ariaDisabled = String(without);
    shell.title = without ? noSpread(view.state) : TOGGLES.shell[1];
    tint.querySelector("[value=sigma]").disabled = without;
  };
  options.on(show);
  model.on("view", spread);
  show();
  holder.append(
    make("div", { className: "scene-tools", role: "toolbar", "aria-label": "How the net is drawn" },
      make("div", { className: "tool-group", hidden: flatOnly }, ...sides, flat),
      make("div", { className: "tool-group" }, ...toggles),
      tint),
    legend(model, options));
}

/** What the colours mean: of the bridles, and of the net where it is tinted. */
function legend(model, options) {
  const load = scale("Bridle load, of capacity");
  const net = scale("");
  const envelope = make("div", { className: "legend-envelope", hidden: true },
    make("span", { className: "envelope-mark" }), make("span"));
  const lock = make("button", {
    type: "button", className: "legend-lock", title: "Lock the scale to the capacity",
    "aria-label": "Lock the scale to the capacity",
  }, padlock());
  lock.addEventListener("click", () => options.set("locked", !options.locked));
  load.head.append(lock);
  const palette = make("button", { type: "button", className: "legend-palette",
    title: "Use the other colour scale" });
  palette.addEventListener("click", () =>
    options.set("scale", options.scale === "viridis" ? "cividis" : "viridis"));
  load.head.append(palette);
  const show = () => {
    const how = { scale: options.scale, theme: theme() };
    lock.ariaPressed = String(options.locked);
    palette.textContent = options.scale;
    load.show(how, "0", `${Math.round(100 * loadEnd(model.view, options))} %`);
    const tint = model.topology && options.view === "3d"
      && tintOf(model.topology, model.view ?? {}, options);
    net.element.hidden = !tint;
    envelope.hidden = !options.shell || !model.view?.position;
    envelope.dataset.known = Boolean(model.view?.sigma);
    envelope.lastChild.textContent = model.view?.sigma ? "±2σ of the net" : "±2σ is not known";
    if (tint) net.show(how, "0", `${tint.end} ${tint.unit}`, tint.name);
  };
  for (const name of ["view", "topology"]) model.on(name, show);
  options.on(show);
  onTheme(show);
  show();
  return make("div", { className: "scene-legend" }, net.element, load.element, envelope);
}

function scale(name) {
  const title = make("span", {}, name);
  const head = make("div", { className: "legend-head" }, title);
  const bar = make("div", { className: "legend-bar" });
  const [from, to] = [make("span"), make("span")];
  return {
    element: make("div", { className: "legend-scale" }, head, bar,
      make("div", { className: "legend-ends" }, from, to)),
    head,
    show(how, low, high, words) {
      bar.style.backgroundImage = gradient(how);
      [from.textContent, to.textContent] = [low, high];
      if (words) title.textContent = words;
    },
  };
}

const padlock = () => draw("svg", {
  viewBox: "0 0 16 16", width: 13, height: 13, "aria-hidden": "true",
}, draw("rect", { x: 3, y: 7, width: 10, height: 7, rx: 1.5, class: "lock-body" }),
  draw("path", { d: "M5 7V5a3 3 0 0 1 6 0v2", class: "lock-bow" }));
