// Which alarms are news.

/** Of the present alarms those that nobody has seen and that were not there before. */
export function fresh(before, alarms) {
  const known = new Set(before.filter(calling).map(({ id }) => id));
  return alarms.filter((alarm) => calling(alarm) && !known.has(alarm.id));
}

const calling = (alarm) => alarm.active && !alarm.acknowledged && !alarm.shelved;
