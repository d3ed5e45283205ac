// The loads as far as they are known: predicted by the twin, and measured by a shackle.

/**
 * What is known of the load on a bridle of a state: [{name, kn, share, by, bridle}]; `by` is the
 * shackle that measured it, null where it is predicted. One that reads irregularly has no say.
 */
function knownLoads(bridle, { alarms = [] }) {
  const { name, measured_by: by } = bridle;
  const believed = !alarms.some(({ id, active }) => active && id === `irregular.${by}`);
  return [
    { name, kn: bridle.tension_kn.mean, share: bridle.utilisation, by: null, bridle },
    { name, kn: bridle.measured_kn, share: believed ? bridle.measured_utilisation : null, by, bridle },
  ].filter(({ share }) => Number.isFinite(share));
}

const largest = (loads) => loads.reduce((a, b) => (a && a.share >= b.share ? a : b), null);
const allLoads = (state) => (state?.bridles ?? []).flatMap((bridle) => knownLoads(bridle, state));

/** The larger of what is known of a bridle's load; null without any. */
export const knownLoad = (bridle, state) => largest(knownLoads(bridle, state));

/** The largest load that is known of a cage, by its share of the capacity; null without any. */
export const largestKnown = (state) => largest(allLoads(state));

/** The largest load that is predicted, to be compared with another prediction; null without any. */
export const largestPredicted = (state) => largest(allLoads(state).filter(({ by }) => !by));
