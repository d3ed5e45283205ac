// The lines of a mooring: their kinds, and which one the reader chose.

/** The line that a selection of the model names, whatever its kind; null where it names none. */
export const chosenLine = (selection) => selection?.bridle ?? selection?.line ?? null;

/** The selection of a line of a cage. */
export const selectionOf = (topology, name) =>
  (topology.bridle_names.includes(name) ? { bridle: name } : { line: name });

/** All lines of a cage whose loads may be known: [{name, kind}], the bridles first. */
export const linesOf = ({ bridle_names: bridles, lines = [] }) =>
  [...bridles.map((name) => ({ name, kind: "bridle" })), ...lines];

/** The kinds among them, each once. */
export const kindsOf = (topology) => [...new Set(linesOf(topology).map(({ kind }) => kind))];

/** The kind of a line of a cage. */
export const kindOf = (topology, name) => linesOf(topology).find((one) => one.name === name)?.kind;

/** What a state says of a line's load in waves; undefined where it says nothing. */
export const lineIn = (state, name) => state?.lines?.find((one) => one.name === name);
