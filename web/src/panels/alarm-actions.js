// What can be done with an alarm, and how each is asked for.

const MINUTE = 60;
const HOUR = 3600;

export const ACTIONS = {
  acknowledge: {
    word: "Acknowledge", title: "Acknowledge this alarm",
    explain: "Somebody has seen it. It stays active until its cause is gone.", demand: false,
  },
  comment: {
    word: "Comment", title: "Comment on this alarm",
    explain: "Your words go into the journal and stay with the alarm.", demand: true,
  },
  shelve: {
    word: "Shelve", title: "Shelve this alarm",
    explain: "It makes nobody look until the time is over. It is evaluated and recorded all the same.",
    demand: true,
  },
  unshelve: {
    word: "Unshelve", title: "Unshelve this alarm", explain: "It is announced again from now on.",
    demand: false,
  },
  "out-of-service": {
    word: "Out of service", title: "Take this alarm out of service",
    explain: "It makes nobody look until somebody puts it back, however long that is.", demand: true,
  },
  "in-service": {
    word: "Back in service", title: "Put this alarm back in service",
    explain: "It is announced again from now on.", demand: true,
  },
};

export const SHELVES = [
  ["15 minutes", 15 * MINUTE], ["1 hour", HOUR], ["4 hours", 4 * HOUR], ["8 hours", 8 * HOUR],
  ["1 day", 24 * HOUR], ["3 days", 72 * HOUR], ["7 days", 168 * HOUR],
];

/** The names of the actions that make sense for an alarm as it is, the likeliest first. */
export function actionsFor(alarm) {
  const seen = alarm.acknowledged ? [] : ["acknowledge"];
  if (alarm.in_service === false) return [...seen, "in-service", "comment"];
  return [...seen, alarm.shelved ? "unshelve" : "shelve", "comment", "out-of-service"];
}

/** How long an alarm can be shelved: one that is active also until it clears. */
export const shelvesFor = (alarm) =>
  alarm.active ? [...SHELVES, ["until it clears", null]] : SHELVES;
