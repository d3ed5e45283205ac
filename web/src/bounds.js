// What physics allows: no tension is below zero, and no depth above the surface.

const atLeastNothing = (value) => (Number.isFinite(value) ? Math.max(0, value) : value);
const PREDICTED = ["mean", "lower", "upper", "low_fidelity"];

function bounded(entry) {
  const changed = PREDICTED.filter((key) => key in entry).map((key) => [key, Array.isArray(entry[key])
    ? entry[key].map(atLeastNothing) : atLeastNothing(entry[key])]);
  return { ...entry, ...Object.fromEntries(changed) };
}

/** A state whose predictions of tensions and depths, with their intervals, are possible. */
export function possible(state) {
  return {
    ...state,
    bridles: state.bridles?.map((one) => ({
      ...one, tension_kn: bounded(one.tension_kn), low_fidelity_kn: atLeastNothing(one.low_fidelity_kn),
    })),
    sensors: state.sensors?.map(bounded),
  };
}

/** The same of a column of the history. */
export const possibleSeries = bounded;
