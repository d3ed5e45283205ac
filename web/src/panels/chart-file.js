// A chart as a file: its curves as a table, or as a picture that says what it shows.

import { word } from "../service-words.js";
import { text } from "../texts/index.js";
import { styled } from "../theme.js";
import { unitName } from "../units.js";
import { moment } from "./format.js";

const COLUMNS = { mean: 5, lower: 1, upper: 2, low: 4, measured: 3 }; // of a chart's rows
const QUOTE = "\u0022";
const SPECIAL = /[\u0022,\r\n]/;
const MARKS = { twin: "--mean", interval: "--band", simulated: "--low", measured: "--measured" };

/** The rows of a chart as CSV: times as in ISO 8601, UTC, and the unit in each head. */
export function csvOf(rows, { unit, origin }) {
  const of = unit === "%" ? "%" : unitName(unit);
  const heads = Object.keys(COLUMNS).map((name) => `${text(`charts.csv.${name}`)} [${of}]`);
  const number = (value) => (Number.isFinite(value) ? String(Number(value.toFixed(6))) : "");
  const lines = rows[0].map((t, k) => [t, Object.values(COLUMNS).map((column) => number(rows[column][k]))])
    .filter(([, values]) => values.some(Boolean)) // a gap is no row
    .map(([t, values]) => [new Date(1000 * t).toISOString(), ...values, origin].map(quoted).join(","));
  return `${[[text("charts.csv.time"), ...heads, text("charts.csv.origin")].map(quoted).join(","), ...lines].join("\r\n")}\r\n`;
}

const quoted = (cell) =>
  (SPECIAL.test(cell) ? QUOTE + cell.replaceAll(QUOTE, QUOTE + QUOTE) + QUOTE : cell);

/** The picture of a plot under a line that says what it is of, and over what its marks mean. */
export function pictureOf(plot, { title, unit, origin, cage, start, end }) {
  const { canvas } = plot.ctx;
  const scale = devicePixelRatio || 1;
  const [head, foot] = [46 * scale, 26 * scale];
  const picture = document.createElement("canvas");
  Object.assign(picture, { width: canvas.width, height: canvas.height + head + foot });
  const pen = picture.getContext("2d");
  pen.fillStyle = styled("--surface");
  pen.fillRect(0, 0, picture.width, picture.height);
  pen.drawImage(canvas, 0, head);
  const write = (words, x, y, colour, weight = 400, size = 12) => {
    pen.fillStyle = styled(colour);
    pen.font = `${weight} ${size * scale}px ${styled("--font")}`;
    pen.fillText(words, x * scale, y * scale);
    return pen.measureText(words).width / scale;
  };
  write(`${cage}, ${title} [${unit === "%" ? unit : unitName(unit)}]`, 10, 18, "--text", 600, 14);
  write(text("charts.pictured", { origin: word(origin), start: moment(start), end: moment(end) }), 10, 36, "--muted");
  let x = 10;
  for (const [name, colour] of Object.entries(MARKS)) {
    pen.fillStyle = styled(colour);
    pen.fillRect(x * scale, picture.height - 16 * scale, 14 * scale, 5 * scale);
    x += 36 + write(text(`mark.${name}`), x + 19, picture.height / scale - 9, "--muted");
  }
  return new Promise((resolve) => { picture.toBlob(resolve, "image/png"); });
}

/** Hand a file to the reader. */
export function save(name, blob) {
  const link = document.createElement("a");
  Object.assign(link, { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
