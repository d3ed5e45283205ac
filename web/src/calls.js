// The service's calls by HTTP, with the token.

import { token } from "./token.js";

/** A call was refused or failed; `status` is HTTP's, 0 where nobody answered. */
export class Refusal extends Error {
  constructor(status, sentence) {
    super(sentence);
    this.name = "Refusal";
    this.status = status;
  }
}

/** Call a path under /api/v1; the answer as JSON, or as bytes where it is a frame. */
export async function call(method, path, body) {
  const known = token();
  if (!known) throw new Refusal(401, "This page has no token.");
  const headers = { Authorization: `Bearer ${known}` };
  if (body !== undefined) headers["Content-Type"] = "application/json";
  let answer;
  try {
    answer = await fetch(`api/v1/${path}`, {
      method, headers, body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch {
    throw new Refusal(0, "The service does not answer.");
  }
  if (!answer.ok) throw new Refusal(answer.status, await reason(answer));
  const kind = answer.headers.get("Content-Type") ?? "";
  if (answer.status === 204) return null;
  return kind.includes("json") ? answer.json() : answer.arrayBuffer();
}

/** Why, in words; a list of faults, as for a malformed body, becomes one sentence. */
async function reason(answer) {
  const { detail } = await answer.json().catch(() => ({}));
  if (Array.isArray(detail)) {
    return detail.map(({ loc, msg }) => `${loc?.at(-1)}: ${msg}`).join("; ");
  }
  return String(detail ?? answer.statusText);
}
