import assert from "node:assert/strict";
import { test } from "node:test";

import { rights } from "../../src/panels/rights.js";

test("scopes are told as what they allow, each where it holds", () => {
  assert.equal(rights(["read", "ack:bay"]), "May see, handle alarms at bay.");
  assert.equal(rights(["read", "admin"]), "May do everything.");
});
