import assert from "node:assert/strict";
import { test } from "node:test";

import { may, rights } from "../../src/panels/rights.js";

test("scopes are shown as what they allow, each where it holds", () => {
  assert.equal(rights(["read", "ack:bay"]), "May look and handle alarms at bay.");
  assert.equal(rights(["read"]), "May look only.");
  assert.equal(rights(["read", "admin"]), "May do everything.");
});

test("a scope for one cage may be enough, another scope is not", () => {
  assert.ok(may(["read", "ack:bay"], "ack"));
  assert.ok(may(["admin"], "ack"));
  assert.ok(!may(["read", "ingest"], "ack"));
});
