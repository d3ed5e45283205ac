// Where the sensors are.

const SHACKLE_AT = 0.14; // of the way from the frame corner to the collar

/** Where each sensor is on a net: [{name, at: [x, y, z]}], depth sensors first. */
export function sensorPlaces(topology, position) {
  const at = (node) => [position[3 * node], position[3 * node + 1], position[3 * node + 2]];
  return [
    ...topology.depth_sensors.map(({ name, node }) => ({ name, at: at(node) })),
    ...topology.shackles.map(({ name, bridle }) => {
      const corner = topology.corner_position_m[topology.bridle_corners[bridle]];
      const end = at(topology.bridle_nodes[bridle]);
      return { name, at: corner.map((one, k) => one + SHACKLE_AT * (end[k] - one)) };
    }),
  ];
}
