// The buttons over the scene: from where, what and in which colours.

import { draw, make } from "../dom.js";
import { withUnit } from "../panels/format.js";
import { text } from "../texts/index.js";
import { onTheme, theme } from "../theme.js";
import { gradient } from "./colours.js";
import { loadEnd, tintOf } from "./paint.js";
import { noSpread } from "./words.js";

const SIDES = ["oblique", "side", "top"];
const TINTS = ["plain", "moved", "sigma"];
const TOGGLES = ["ghost", "shell", "sea"];

/** Add them; `look` turns to a named side, in three dimensions. */
export function mountControls(model, options, holder, { look, flatOnly }) {
  const pressed = new Map();
  const button = (name, words, title, does) => {
    const made = make("button", { type: "button", title }, words);
    made.addEventListener("click", does);
    pressed.set(name, made);
    return made;
  };
  const sides = SIDES.map((name) =>
    button(name, text(`scene.sides.${name}`), text("scene.look"), () => look(name)));
  const flat = button("flat", text("scene.flat"), text("scene.flatTitle"), () =>
    options.set("view", options.view === "flat" ? "3d" : "flat"));
  const toggles = TOGGLES.map((name) =>
    button(name, text(`scene.toggles.${name}.word`), text(`scene.toggles.${name}.title`), () =>
      pressed.get(name).ariaDisabled !== "true" && options.set(name, !options[name])));
  const tint = make("select", { title: text("scene.tintTitle"), "aria-label": text("scene.tint") },
    ...TINTS.map((value) => make("option", { value }, text(`scene.tints.${value}`))));
  tint.addEventListener("change", () => options.set("tint", tint.value));

  const show = () => {
    const isFlat = flatOnly || options.view === "flat";
    for (const name of TOGGLES) pressed.get(name).ariaPressed = String(options[name]);
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
    shell.title = without ? noSpread(view.state) : text("scene.toggles.shell.title");
    tint.querySelector("[value=sigma]").disabled = without;
  };
  options.on(show);
  model.on("view", spread);
  show();
  holder.append(
    make("div", { className: "scene-tools", role: "toolbar", "aria-label": text("scene.tools") },
      make("div", { className: "tool-group", hidden: flatOnly }, ...sides, flat),
      make("div", { className: "tool-group" }, ...toggles),
      tint),
    legend(model, options));
}

/** What the colours mean: of the bridles, and of the net where it is tinted. */
function legend(model, options) {
  const load = scale(text("scene.load"));
  const net = scale("");
  const envelope = make("div", { className: "legend-envelope", hidden: true },
    make("span", { className: "envelope-mark" }), make("span"));
  const lock = make("button", {
    type: "button", className: "legend-lock", title: text("scene.lock"), "aria-label": text("scene.lock"),
  }, padlock());
  lock.addEventListener("click", () => options.set("locked", !options.locked));
  load.head.append(lock);
  const palette = make("button", { type: "button", className: "legend-palette", title: text("scene.palette") });
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
    envelope.lastChild.textContent = model.view?.sigma ? text("scene.envelope") : text("scene.noEnvelope");
    if (tint) net.show(how, "0", withUnit(tint.end, tint.unit, tint.end < 1 ? 2 : 0), tint.name);
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
