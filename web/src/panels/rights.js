// What a token's scopes let its holder do, in words.

const WORDS = { read: "look", ack: "handle alarms", ingest: "send samples" };

/** Say in a sentence what the scopes allow; one may hold for a single cage, as `ack:bay`. */
export function rights(scopes) {
  if (scopes.includes("admin")) return "May do everything.";
  const may = scopes.map((scope) => {
    const [action, where] = scope.split(":");
    return `${WORDS[action] ?? action}${where ? ` at ${where}` : ""}`;
  });
  return may.length > 1 ? `May ${may.slice(0, -1).join(", ")} and ${may.at(-1)}.` : `May ${may[0]} only.`;
}

/** Whether the scopes may let their holder do something here; where, the service alone knows. */
export const may = (scopes, action) =>
  scopes.some((scope) => scope === "admin" || scope.split(":")[0] === action);
