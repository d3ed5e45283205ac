// Where things are on the rose: north up, clockwise, a load's length from the middle outwards.

import { turned } from "./format.js";

export const INNER = 24;
export const OUTER = 92;
const HALF_WIDTH = 7; // of a bar [degrees]

/** x and y at a compass direction and a radius. */
export function polar(degrees, radius) {
  const angle = (degrees * Math.PI) / 180;
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}

/** How far two compass directions are apart [degrees]. */
export const apart = (a, b) => Math.abs(((((a - b) % 360) + 540) % 360) - 180);

/** The radius of a share on a scale; what is beyond its end stays just outside. */
export function radius(share, end) {
  return INNER + (OUTER - INNER) * Math.min(1.04, Math.max(0, share / end));
}

/** The outline of a bar from the middle to a radius. */
export function wedge(degrees, to) {
  const [a, b] = [degrees - HALF_WIDTH, degrees + HALF_WIDTH];
  const arc = (r, sweep, at) => `A${r} ${r} 0 0 ${sweep} ${point(at, r)}`;
  return `M${point(a, INNER)}${arc(INNER, 1, b)}L${point(b, to)}${arc(to, 0, a)}Z`;
}

/** A short line across a bar at a radius. */
export function across(degrees, at, half = HALF_WIDTH) {
  return `M${point(degrees - half, at)}A${at} ${at} 0 0 1 ${point(degrees + half, at)}`;
}

/** A line along a bar between two radii, with a cap at each end. */
export function whisker(degrees, from, to) {
  return `M${point(degrees, from)}L${point(degrees, to)}` +
    across(degrees, from, 2.6) + across(degrees, to, 2.6);
}

/** Where each bridle leaves the collar, as seen from above [compass degrees]. */
export const azimuths = ({ bridle_nodes: nodes, rest_position_m: rest }) =>
  nodes.map((node) => bearing(rest[node]));

/** The lines of a kind and where each is as seen from above: a bridle's collar end, else the middle. */
export function around(topology, kind) {
  if (kind === "bridle") {
    const directions = azimuths(topology);
    return topology.bridle_names.map((name, k) => ({ name, direction: directions[k] }));
  }
  return topology.lines.filter((one) => one.kind === kind).map(({ name, ends_m: [a, b] }) =>
    ({ name, direction: bearing([a[0] + b[0], a[1] + b[1]]) }));
}

const bearing = ([x, y]) => turned((Math.atan2(x, y) * 180) / Math.PI);

const point = (degrees, r) => polar(degrees, r).map((value) => value.toFixed(2)).join(" ");
