// The stand-in service's alarms: a list that remembers what was done to it.

const ALARMS = {
  load: [{
    id: "load.bridle-8", kind: "load", source: "bridle-8", severity: 850, unit: "kN",
    title: "Load on bridle-8", message: "bridle-8 carries 71 % of its capacity.",
    advice: "Look at the bridle and its neighbours; slacken or relieve them if the current grows.",
    value: 0.71, worst: 0.78, raise_at: 0.6, clear_at: 0.5,
  }, {
    id: "irregular.depth-2", kind: "irregular", source: "depth-2", severity: 560, unit: "m",
    title: "depth-2 drifts", message: "depth-2 has read 0.6 m too deep for three hours.",
    advice: "Check the sensor before you trust it; the net beside it behaves as expected.",
    value: 5.2, worst: 5.9, raise_at: 5, clear_at: 3,
  }],
  silent: [...["depth-1", "depth-2", "shackle-3"].map((one) => ({
    id: `silent.${one}`, kind: "silent", source: one, severity: 500, unit: "s",
    title: `${one} is silent`, message: `${one} has sent nothing for 1.8 h; 15 min is the limit.`,
    advice: "Check its power, its radio and its clock.", value: 6500, worst: 6500, raise_at: 900, clear_at: 600,
  })), {
    id: "clock.service", kind: "clock", source: "service", severity: 600, unit: "1",
    title: "Wrong clock: service", message: "The clock of the service was set back by 1.0 h at 03:12 UTC.",
    advice: "Set the clock, and see that it is kept by NTP or GPS. What is shown follows the "
      + "readings that are not ahead of the service's clock.",
    value: 1, worst: 1, raise_at: 1, clear_at: 0,
  }, {
    id: "silent.buoy-1", kind: "silent", source: "buoy-1", severity: 700, unit: "s",
    title: "buoy-1 is silent", message: "buoy-1 has sent nothing for 2.0 h.",
    advice: "Check its power and its link; loads and shape are unknown until it is back.",
    value: 7300, worst: 7300, raise_at: 1800, clear_at: 1800,
  }],
};
const DONE = {
  acknowledge: { acknowledged: true }, comment: {}, shelve: { shelved: true },
  unshelve: { shelved: false }, "out-of-service": { in_service: false },
  "in-service": { in_service: true },
};

/** The alarms of a cage with a trouble, and its journal. */
export function alarmsFor(trouble, now) {
  const since = new Date(now - 47 * 60e3).toISOString();
  const alarms = structuredClone(ALARMS[trouble] ?? []).map((alarm) => ({
    ...alarm, active: true, acknowledged: false, shelved: false, shelved_until: null,
    in_service: true, since, comment: "",
  }));
  const lines = alarms.map((alarm) => ({
    alarm: alarm.id, action: "raised", t: since, value: alarm.value, who: "", why: "", quiet: false,
  }));
  return {
    alarms,
    lines,
    brief: () => alarms.filter((one) => one.active || !one.acknowledged),
    act(id, action, { why, seconds }, t) {
      const alarm = alarms.find((one) => one.id === id);
      if (!alarm || !DONE[action]) return null;
      Object.assign(alarm, DONE[action], { comment: why || alarm.comment });
      if (action === "shelve") alarm.shelved_until = new Date(t + 1000 * (seconds ?? 3600)).toISOString();
      lines.push({ alarm: id, action, t: new Date(t).toISOString(), value: null,
        who: "you", why: why ?? "", quiet: false });
      return alarm;
    },
  };
}

/** Figures of an alarm system, made up. */
export const kpi = {
  start: "2026-01-01T00:00:00Z", end: "2026-01-02T00:00:00Z", raised: { "load.bridle-8": 4 },
  per_day: 4, most_in_an_hour: 3, standing: {}, longest_s: { "load.bridle-8": 5400 },
  chattering: ["load.bridle-8"], to_acknowledge_s: 240, unacknowledged: 1,
};
