// A cage that answers by formula: made-up numbers to build the page with, never shown to users.

const SPOKES = 32;
const DEPTHS = [0, 3.5, 7, 10, 12.5, 15, 18.2, 21.4, 24.6, 27.8];
const BEARINGS = [67.5, 45, 22.5, 337.5, 315, 292.5, 247.5, 225, 202.5, 157.5, 135, 112.5];
const CORNERS = [[42.5, 42.5], [-42.5, 42.5], [-42.5, -42.5], [42.5, -42.5]];
const CAPACITY_KN = 160;
const SHACKLES = [6, 7, 8, 9, 10];
const SENSOR_DEPTHS = [7, 15, 31];
const REASON = "No sensor has trained level 2 here, so the error of the simulation is not known.";
const radians = (degrees) => (degrees * Math.PI) / 180;

const rest = [];
for (const depth of DEPTHS) {
  const radius = 25 * Math.min(1, (31 - depth) / 16);
  for (let k = 0; k < SPOKES; k += 1) {
    const turn = (2 * Math.PI * k) / SPOKES;
    rest.push([radius * Math.cos(turn), radius * Math.sin(turn), -depth]);
  }
}
rest.push([0, 0, -31]);

const nodeAt = (ring, bearing) =>
  SPOKES * ring + (((Math.round(((90 - bearing) / 360) * SPOKES) % SPOKES) + SPOKES) % SPOKES);

function edges() {
  const found = [];
  for (let ring = 0; ring < DEPTHS.length; ring += 1) {
    for (let k = 0; k < SPOKES; k += 1) {
      const at = SPOKES * ring + k;
      found.push([at, SPOKES * ring + ((k + 1) % SPOKES)]);
      found.push([at, ring + 1 < DEPTHS.length ? at + SPOKES : rest.length - 1]);
    }
  }
  return found;
}

const bridleNodes = BEARINGS.map((bearing) => nodeAt(0, bearing));
const bridleCorners = bridleNodes.map((node) => {
  const apart = CORNERS.map(([x, y]) => Math.hypot(x - rest[node][0], y - rest[node][1]));
  return apart.indexOf(Math.min(...apart));
});
const sensorNodes = SENSOR_DEPTHS.map((depth) =>
  depth === 31 ? rest.length - 1 : nodeAt(DEPTHS.indexOf(depth), 180));

/** Frame, anchor and buoy lines. */
function moored() {
  const corners = CORNERS.map(([x, y]) => [x, y, -8]);
  const out = ([x, y]) => [[Math.sign(x) * 60, 0], [0, Math.sign(y) * 60]];
  return [
    ...corners.map((one, k) => ({ kind: "frame line", name: `frame-${k + 1}`, ends_m: [one, corners[(k + 1) % 4]] })),
    ...corners.flatMap((one, k) => out(one).map(([x, y], side) => ({ kind: "anchor line",
      name: `anchor-${2 * k + side + 1}`, ends_m: [one, [one[0] + x, one[1] + y, -28]] }))),
    ...corners.map((one, k) => ({ kind: "buoy line", name: `buoy-${k + 1}`, ends_m: [one, [one[0], one[1], 0]] })),
  ];
}

export const topologyOf = (name, speed) => ({
  kind: "topology", topology_id: `made-up-${name}`, cage: name, origin: "virtual field",
  spokes: SPOKES, rings: DEPTHS.length, edges: edges(), rest_position_m: rest,
  corner_position_m: CORNERS.map(([x, y]) => [x, y, -8]),
  bridle_names: BEARINGS.map((_, k) => `bridle-${k + 1}`), bridle_nodes: bridleNodes,
  bridle_corners: bridleCorners, bridle_capacity_kn: BEARINGS.map(() => CAPACITY_KN),
  depth_sensors: sensorNodes.map((node, k) => ({ name: `depth-${k + 1}`, node })),
  shackles: SHACKLES.map((bridle, k) => ({ name: `shackle-${k + 1}`, bridle })),
  lines: moored(), water_depth_m: 191, stale_after_s: 1800, speed,
});

export const learned = {
  inputs: [
    { key: "current_speed_m_s", most: 0.9 }, { key: "current_to_deg", most: null },
    { key: "hs_m", most: 3 }, { key: "wave_from_deg", most: null },
  ],
  unknown: ["tp_s"],
};

/** The made-up sea at a time [ms]: a tide that turns, some weather, some noise. */
export function seaAt(t, strength = 1) {
  const hours = t / 3.6e6;
  const tide = Math.sin((2 * Math.PI * hours) / 12.42);
  const weather = 0.5 + 0.5 * Math.sin(hours / 17);
  return {
    current_speed_m_s: strength * (0.12 + 0.5 * Math.abs(tide) * (0.6 + 0.4 * weather)
      + 0.03 * Math.sin(hours * 29)),
    current_to_deg: (tide > 0 ? 62 : 238) + 14 * Math.sin(hours / 3),
    hs_m: 0.6 + 1.4 * weather, tp_s: 4.5 + 2 * weather, wave_from_deg: 285 + 20 * Math.sin(hours / 9),
  };
}

/** How the net lies in a sea: displacement x y z of each node in turn, and sigma [m]. */
export function shapeIn(sea) {
  const u = Math.max(0, sea.current_speed_m_s);
  const [east, north] = [Math.sin(radians(sea.current_to_deg)), Math.cos(radians(sea.current_to_deg))];
  const displacement = [];
  const sigma = [];
  for (const [x, y, z] of rest) {
    const depth = -z / 31;
    const along = x * east + y * north;
    const sway = 0.8 * u + 8.5 * u * u * depth ** 1.2;
    const dent = 2.6 * u * u * Math.sin(Math.PI * Math.min(1, depth * 1.4)) * (along < 0 ? 1 : 0.25);
    displacement.push((sway + dent) * east, (sway + dent) * north,
      7 * u * u * depth * (1 - 0.012 * along) + 0.15 * sea.hs_m * (1 - depth) * Math.sin(along / 9));
    sigma.push(0.1 + 3 * u * depth);
  }
  return { displacement, sigma };
}

const interval = (mean, half) => ({ mean, lower: mean - half, upper: mean + half });
const wave = (t, k) => Math.sin(t / 43e3 + 1.7 * k) * Math.cos(t / 151e3 + k);

/** What each line and sensor says in a sea; `broken` adds an excursion. */
export function answersIn(sea, t, broken) {
  const u = sea.current_speed_m_s;
  const low = bridleNodes.map((node, k) => {
    const [x, y] = rest[node];
    const [cx, cy] = CORNERS[bridleCorners[k]];
    const length = Math.hypot(cx - x, cy - y);
    const pull = -(((cx - x) * Math.sin(radians(sea.current_to_deg))
      + (cy - y) * Math.cos(radians(sea.current_to_deg))) / length);
    return 4 * Math.log(1 + Math.exp((10 + 230 * u * u * pull) / 4));
  });
  const bridles = low.map((kn, k) => {
    const shackle = SHACKLES.indexOf(k);
    const level = shackle < 0 ? 1 : 2;
    const mean = kn * (level === 2 ? 1.13 : 1) * (broken && k === 7 ? 1.8 : 1);
    const measured = level === 2 ? mean * (1 + 0.04 * wave(t, shackle)) : null;
    return {
      name: `bridle-${k + 1}`, level, in_domain: true,
      tension_kn: level === 2 ? interval(mean, 1 + 0.05 * mean) : { mean, lower: null, upper: null },
      interval_reason: level === 2 ? "" : REASON,
      low_fidelity_kn: kn, utilisation: mean / CAPACITY_KN, measured_kn: measured,
      measured_utilisation: level === 2 ? measured / CAPACITY_KN : null,
      measured_by: level === 2 ? `shackle-${shackle + 1}` : null,
    };
  });
  const { displacement } = shapeIn(sea);
  const shackles = SHACKLES.map((bridle, k) => {
    const { tension_kn: kn } = bridles[bridle];
    return {
      name: `shackle-${k + 1}`, unit: "kN", level: 2, low_fidelity: low[bridle], ...kn,
      in_domain: true, measured: bridles[bridle].measured_kn, measured_age_s: 20,
    };
  });
  const depths = sensorNodes.map((node, k) => {
    const metres = -(rest[node][2] + displacement[3 * node + 2]);
    return {
      name: `depth-${k + 1}`, unit: "m", level: 2, in_domain: true, low_fidelity: metres + 0.4, ...interval(metres, 0.35),
      measured: metres + 0.2 * wave(t, k + 9), measured_age_s: 40,
    };
  });
  return { bridles, sensors: [...shackles, ...depths] };
}
