// Only the newest question waits, and an answer that was overtaken is dropped.

import assert from "node:assert/strict";
import { test } from "node:test";

import { latestOnly } from "../src/latest.js";

function held() {
  const questions = [];
  const settle = [];
  const ask = latestOnly((question) => new Promise((resolve, reject) => {
    questions.push(question);
    settle.push({ resolve, reject });
  }));
  return { ask, questions, settle };
}

test("of the questions that wait only the last is put", async () => {
  const { ask, questions, settle } = held();
  const answers = [ask(1), ask(2), ask(3)];
  settle[0].resolve("one");
  await answers[0];
  settle[1].resolve("three");
  assert.deepEqual(await Promise.all(answers), [undefined, undefined, "three"]);
  assert.deepEqual(questions, [1, 3]);
});

test("a lone question is answered", async () => {
  const { ask, settle } = held();
  const answer = ask(1);
  settle[0].resolve("one");
  assert.equal(await answer, "one");
});

test("a failure goes to the last question, and the next one is put", async () => {
  const { ask, settle } = held();
  const first = ask(1);
  settle[0].reject(new Error("no"));
  await assert.rejects(first, /no/);
  const second = ask(2);
  settle[1].resolve("two");
  assert.equal(await second, "two");
});

test("the failure of an overtaken question troubles nobody", async () => {
  const { ask, settle } = held();
  const [first, second] = [ask(1), ask(2)];
  settle[0].reject(new Error("no"));
  assert.equal(await first, undefined);
  settle[1].resolve("two");
  assert.equal(await second, "two");
});
