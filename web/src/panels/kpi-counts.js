// How well the alarms do their work, counted from the journal.

const CHATTER_MS = 600e3;
const CHATTER_TIMES = 3;
const DAY_MS = 86400e3;

/**
 * Count lines of the journal, in time order, over a span that ends at `end` [ms].
 *
 * Standing: raised and not cleared within the span. Chattering: raised three times within ten
 * minutes. An alarm that was already active when the span began counts from its begin if the
 * journal shows it clearing.
 */
export function counted(lines, { start, end }) {
  const names = [...new Set(lines.map(({ alarm }) => alarm))];
  const each = names.map((name) => one(name, lines.filter(({ alarm }) => alarm === name), start, end))
    .filter(({ raised, longestS }) => raised || longestS);
  const waits = each.flatMap(({ seenAfterS }) => seenAfterS).sort((a, b) => a - b);
  return {
    raised: sum(each.map(({ raised }) => raised)),
    perDay: sum(each.map(({ raised }) => raised)) / Math.max(1 / 24, (end - start) / DAY_MS),
    standing: each.filter(({ standing }) => standing).length,
    chattering: each.filter(({ chatters }) => chatters).length,
    longestS: Math.max(0, ...each.map(({ longestS }) => longestS)),
    seenAfterS: waits.length ? waits[Math.floor(waits.length / 2)] : null,
    each: each.sort((a, b) => b.raised - a.raised || b.longestS - a.longestS),
  };
}

function one(name, lines, start, end) {
  const raised = [], seenAfterS = [];
  let since = null, unseen = null, longest = 0;
  for (const { action, t } of lines) {
    const when = Date.parse(t);
    if (action === "raised") {
      raised.push(when);
      since = when;
      unseen = when;
    }
    if (action === "acknowledged" && unseen !== null) {
      seenAfterS.push((when - unseen) / 1000);
      unseen = null;
    }
    if (action === "cleared") {
      longest = Math.max(longest, when - (since ?? (raised.length ? when : start)));
      since = null;
    }
  }
  if (since !== null) longest = Math.max(longest, end - since);
  const chatters = raised.some((when, k) => raised[k + CHATTER_TIMES - 1] - when <= CHATTER_MS);
  return { name, raised: raised.length, standing: since !== null, longestS: longest / 1000, chatters, seenAfterS };
}

const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
