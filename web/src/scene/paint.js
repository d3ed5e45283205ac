// Which colour the net, the bridles and the sensors have.

import { knownLoad } from "../known-load.js";
import { text } from "../texts/index.js";
import { styled, theme } from "../theme.js";
import { alarmed, cssColour, scaleColour } from "./colours.js";
import { movedBy } from "./geometry.js";

const NICE = [0.1, 0.2, 0.25, 0.5, 1, 2, 4, 6, 8, 10, 15, 20, 30, 50];
const RANK = { critical: "--critical", warning: "--warning", note: "--note" };

/** The end of a scale that holds the values: a round number. */
const roundEnd = (values) => {
  const most = values.reduce((a, b) => Math.max(a, b), 0);
  return NICE.find((one) => one >= most) ?? Math.ceil(most);
};

/** The scale of the bridles' utilisation: its end, 1 where it is locked. */
export const loadEnd = (view, { locked }) =>
  locked || !view?.state.valid ? 1
    : roundEnd(view.state.bridles.map((bridle) => knownLoad(bridle, view.state)?.share ?? 0));

/** CSS colours of the bridles: by the largest known load, unless an alarm speaks. */
export function bridleColours(topology, view, options) {
  const alarms = alarmed(view?.state);
  const end = loadEnd(view, options);
  const how = { scale: options.scale, theme: theme() };
  return topology.bridle_names.map((name, k) => {
    const bridle = view?.state.bridles[k];
    if (alarms.has(name)) return styled(RANK[alarms.get(name)]);
    const load = bridle && knownLoad(bridle, view.state);
    return load ? cssColour(load.share / end, how) : styled("--rope");
  });
}

/** The CSS colour of a sensor's mark. */
export function sensorColour(view, name) {
  const alarm = alarmed(view?.state).get(name);
  if (alarm) return styled(RANK[alarm]);
  const sensor = view?.state.sensors.find((one) => one.name === name);
  return styled(sensor && sensor.measured !== null ? "--measured" : "--muted");
}

/** What the netting's colour says: {values, end, unit, name}; null where it is plain. */
export function tintOf(topology, { position, sigma } = {}, { tint }) {
  if (tint === "plain" || !position || (tint === "sigma" && !sigma)) return null;
  const values = tint === "moved" ? movedBy(position, topology.rest) : sigma;
  const name = tint === "moved" ? text("scene.moved") : text("scene.sigma");
  return { values, end: roundEnd(values), unit: "m", name };
}

/** [r, g, b] of 0..255 for each node; one for all where the tint is plain. */
export function netColours(topology, tint, options) {
  if (!tint) return [rgb(styled("--net"))];
  const how = { scale: options.scale, theme: theme() };
  return Array.from(tint.values, (value) => scaleColour(value / tint.end, how));
}

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
