// What a token's scopes let its holder do, in words.

import { text } from "../texts/index.js";

const KNOWN = new Set(["read", "ack", "ingest"]);

/** Say in a sentence what the scopes allow; one may hold for a single cage, as `ack:bay`. */
export function rights(scopes) {
  if (scopes.includes("admin")) return text("rights.admin");
  const may = scopes.map((scope) => {
    const [name, where] = scope.split(":");
    const action = KNOWN.has(name) ? text(`rights.action.${name}`) : name;
    return where ? text("rights.at", { action, where }) : action;
  });
  if (may.length === 1) return text("rights.one", { action: may[0] });
  return text("rights.several", { actions: may.slice(0, -1).join(", "), last: may.at(-1) });
}

/** Whether the scopes may let their holder do something here; where, the service alone knows. */
export const may = (scopes, action) =>
  scopes.some((scope) => scope === "admin" || scope.split(":")[0] === action);
