// The loads as far as they are known: predicted by the twin, and measured by a shackle.

/**
 * What is known of the load on a bridle of a state: [{name, kn, share, by, bridle}]; `by` is the
 * shackle that measured it, null where it is predicted. One that reads irregularly has no say.
 */
export function knownLoads(bridle, { alarms = [] }) {
  const { name, measured_by: by } = bridle;
  const believed = !alarms.some(({ id, active }) => active && id === `irregular.${by}`);
  return [
    { name, kn: bridle.tension_kn.mean, share: bridle.utilisation, by: null, bridle },
    { name, kn: bridle.measured_kn, share: believed ? bridle.measured_utilisation : null, by, bridle },
  ].filter(({ share }) => Number.isFinite(share));
}

const larger = (a, b) => (b.share > a.share ? b : a);

/** The larger of what is known of a bridle's load; null without any. */
export function knownLoad(bridle, state) {
  const loads = knownLoads(bridle, state);
  return loads.length ? loads.reduce(larger) : null;
}

/** The largest load that is predicted, to be compared with another prediction; null without any. */
export function largestPredicted(state) {
  const loads = (state?.bridles ?? []).flatMap((bridle) => knownLoads(bridle, state)).filter(({ by }) => !by);
  return loads.length ? loads.reduce(larger) : null;
}

/** The largest load that is known of a cage, by its share of the capacity; null without any. */
export function largestKnown(state) {
  const loads = (state?.bridles ?? []).flatMap((bridle) => knownLoads(bridle, state));
  return loads.length ? loads.reduce(larger) : null;
}
