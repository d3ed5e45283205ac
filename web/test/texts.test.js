import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

import en from "../src/texts/en.js";
import { LANGUAGES, text } from "../src/texts/index.js";

const SRC = new URL("../src/", import.meta.url);
const PLURALS = new Set(["zero", "one", "two", "few", "many", "other"]);

const files = readdirSync(fileURLToPath(SRC), { recursive: true })
  .map((name) => name.replaceAll("\\", "/")).filter((name) => /\.(js|svelte)$/.test(name));
const languages = files.filter((name) => name.startsWith("texts/") && !name.endsWith("index.js"));
const sources = files.filter((name) => !name.startsWith("texts/"))
  .map((name) => ({ name, code: bare(readFileSync(new URL(name, SRC), "utf8")) }));

/** A script without its comments, its imports and its shaders. */
function bare(code) {
  return code
    .replace(/^import[\s\S]*?;$/gm, "")
    .replace(/^const (VERTEX|FRAGMENT) = `[\s\S]*?`;/gm, "")
    .replace(/\/\*[\s\S]*?\*\/|(^|\s)\/\/.*$/gm, "");
}

const isText = (node) => typeof node === "string" || Object.keys(node).every((name) => PLURALS.has(name));

/** All texts below a node by key: [key, strings]. */
function textsOf(node, key = "") {
  if (isText(node)) return [[key, typeof node === "string" ? [node] : Object.values(node)]];
  return Object.entries(node).flatMap(([name, below]) => textsOf(below, key ? `${key}.${name}` : name));
}

/** Keys of the calls of `text`, as patterns: one with a `${…}` stands for several keys. */
function keysIn(code) {
  return [...code.matchAll(/\btext\(\s*(?:"([^"]*)"|`([^`]*)`|)/g)].map(([call, plain, template]) => {
    assert.ok(plain ?? template, `${call}… has no key that can be looked up here`);
    return new RegExp(`^${(plain ?? template).replaceAll(".", "\\.").replace(/\$\{.*?\}/g, "[\\w-]+")}$`);
  });
}

/** Text that stands in a script: words where a reader sees them, or a sentence anywhere. */
function wordsIn(code) {
  const literal = /"((?:[^"\\\n]|\\.)*)"|'((?:[^'\\\n]|\\.)*)'|`((?:[^`\\]|\\.)*)`/g;
  const shown = /(\b(title|alt|placeholder|label|textContent|aria-?(?!labelledby|controls)\w+"?)\s*[:=]\s*|["'](title|aria-\w+)["'],\s*|\bempty\(\s*|\bwrite\([^,]+,\s*|\b(make|draw)\("[\w-]+", (\{[^{}]*\}|properties),\s*)$/;
  const technical = /(\b(class|className|d|viewBox|role|transform|font|command|preserveAspectRatio|style\.\w+)\s*[:=]\s*|\b(matchMedia|querySelector(All)?|closest|getExtension|replace|includes)\(\s*|\b(KEY|WRITES|PRESSES)\s*=\s*)$/;
  return [...code.matchAll(literal)].filter((found) => {
    const before = code.slice(Math.max(0, found.index - 80), found.index);
    const words = (found[1] ?? found[2] ?? found[3]).replace(/\$\{[^{}]*(\{[^{}]*\}[^{}]*)*\}/g, "").replace(/\\.|\b(seacage|UTC)\b/g, " ");
    if (technical.test(before)) return false;
    if (shown.test(before)) return /\p{L}{2}/u.test(words) && !/^(true|false|polite|off)$/.test(words);
    return /\p{L}{2,}[.,:;]? \p{L}/u.test(words) || /^\s*\p{Lu}\p{Ll}+[\s.:]/u.test(words);
  }).map(([whole]) => whole);
}

test("every key that the page looks up has a text, and every text is looked up", () => {
  const keys = textsOf(en).map(([key]) => key);
  const patterns = sources.flatMap(({ code }) => keysIn(code));
  assert.deepEqual(patterns.filter((pattern) => !keys.some((key) => pattern.test(key))), []);
  assert.deepEqual(keys.filter((key) => !patterns.some((pattern) => pattern.test(key))), []);
});

test("no script has words of its own for the reader", () => {
  for (const { name, code } of sources) assert.deepEqual(wordsIn(code), [], name);
});

test("words in a script are found wherever they stand", () => {
  for (const code of [
    'make("p", {}, "now")', 'make("p", { className: "x" }, "Now")', '{ title: "Help" }', 'one.ariaLabel = "Close"',
    'setAttribute("aria-label", "Close")', 'return "It is gone."', "x = `Asked ${who} again`", '{ "aria-label": "Net" }',
    'write(this.note, "late")', "empty('Nothing', why)",
  ]) assert.equal(wordsIn(code).length, 1, code);
});

test("every language has every text of English, with the same placeholders", async () => {
  const names = (strings) => [...new Set(strings.flatMap((one) => one.match(/\{\w+\}/g) ?? []))].sort();
  const english = new Map(textsOf(en));
  for (const file of languages) {
    const { default: texts } = await import(new URL(file, SRC));
    const own = new Map(textsOf(texts));
    assert.deepEqual([...own.keys()].sort(), [...english.keys()].sort(), file);
    for (const [key, strings] of own) assert.deepEqual(names(strings), names(english.get(key)), `${file}: ${key}`);
  }
});

test("no text of another language is left in English", async () => {
  const english = new Map(textsOf(en));
  const same = new Set(["line", "pause", "side", "alarm", "over", "min", "esc", "utc"]); // in both
  const isEnglish = (words) => (words.replace(/\{\w+\}/g, "").match(/\p{L}{3,}/gu) ?? []).some((one) => !same.has(one.toLowerCase()));
  for (const file of languages.filter((name) => !name.endsWith("en.js"))) {
    const { default: texts } = await import(new URL(file, SRC));
    const left = textsOf(texts).filter(([key, [words]]) => words === english.get(key)[0] && isEnglish(words));
    assert.deepEqual(left, [], file);
  }
});

test("every file of texts is a language that the reader can choose", () => {
  assert.deepEqual(languages.map((name) => name.slice("texts/".length, -".js".length)).sort(), Object.keys(LANGUAGES).sort());
});

test("a text takes its values and the plural of its count", () => {
  assert.equal(text("count.alarms", { count: 1 }), "1 alarm");
  assert.equal(text("count.alarms", { count: 0 }), "0 alarms");
  assert.equal(text("tabs.key", { key: 3 }), "Key 3");
});

test("a value with a sign of a pattern stays as it is", () => {
  assert.equal(text("who.token", { who: "$& {who}" }), "Token “$& {who}”");
});
