// What a token's scopes let its holder do, in words.

const WORDS = { read: "see", ack: "handle alarms", ingest: "send samples" };

/** Say in a sentence what the scopes allow; one may hold for a single cage, as `ack:bay`. */
export function rights(scopes) {
  if (scopes.includes("admin")) return "May do everything.";
  const may = scopes.map((scope) => {
    const [action, where] = scope.split(":");
    return `${WORDS[action] ?? action}${where ? ` at ${where}` : ""}`;
  });
  return `May ${may.join(", ")}.`;
}
