// Asking the service by HTTP, and its refusals in words.

import { text } from "./texts/index.js";

/** A path below that of a cage. */
export const cagePath = (cage, rest) => `cages/${encodeURIComponent(cage)}/${rest}`;

/** A call was refused or failed; `status` is HTTP's, 0 where nobody answered. */
export class Refusal extends Error {
  constructor(status, sentence) {
    super(sentence);
    this.name = "Refusal";
    this.status = status;
  }
}

/** Ask an address of the service; the answer as JSON, or as bytes where it is a frame. */
export async function request(method, address, { body, headers = {} } = {}) {
  const kind = body === undefined ? {} : { "Content-Type": "application/json" };
  let answer;
  try {
    answer = await fetch(address, {
      method, headers: { ...kind, ...headers }, body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch {
    throw new Refusal(0, text("connection.noAnswer"));
  }
  if (!answer.ok) throw new Refusal(answer.status, await reason(answer));
  if (answer.status === 204) return null;
  const contentType = answer.headers.get("Content-Type") ?? "";
  return contentType.includes("json") ? answer.json() : answer.arrayBuffer();
}

/** Why, in words; a list of faults, as for a malformed body, becomes one sentence. */
async function reason(answer) {
  const { detail } = await answer.json().catch(() => ({}));
  if (Array.isArray(detail)) {
    return detail.map(({ loc, msg }) => `${loc?.at(-1)}: ${msg}`).join("; ");
  }
  return String(detail ?? answer.statusText);
}
