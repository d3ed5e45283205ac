// Small helpers: elements without innerHTML, and what the style sheet has to say.

/** Make an element with properties and children; text is never read as HTML. */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/** A legend: what each key stands for. */
export function explain(holder, items) {
  holder.replaceChildren(...Object.entries(items).map(([key, words]) =>
    make("span", { className: "item" }, make("span", { className: `key ${key}` }), words)));
}

/** The element with an id. */
export const byId = (id) => document.getElementById(id);

/** A colour or number of the style sheet. */
export const styled = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Whether the reader asked for stillness. */
export const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Fit a canvas to its box at the screen's own resolution; its drawing context, cleared. */
export function cleared(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const scale = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** Mix two colours given as #rrggbb. */
export function mixed(a, b, share) {
  const parts = [1, 3, 5].map((at) => {
    const [from, to] = [a, b].map((colour) => parseInt(colour.slice(at, at + 2), 16));
    return Math.round(from + (to - from) * share);
  });
  return `rgb(${parts.join(" ")})`;
}
