"""Level 2 of the net: its simulated shape in the current that the depth sensors agree with."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from seacage.surrogates import FittedShapeGP, Prediction
from seacage.twin._answer import PerNode
from seacage.twin._metocean import Input, Metocean

PerCase = Float[np.ndarray, " case"]
Size = Float[np.ndarray, "*case"]
PerSensor = Float[np.ndarray, "case sensor"]

LEAST_SENSORS = 2  # depth sensors with a calibrated level 2: one may be off in its own way

# Currents over the buoy's at which level 1 is evaluated [-], and those read between them
STEPS = np.geomspace(0.6, 3.0, 9)
BETWEEN = np.geomspace(0.6, 3.0, 33)
_SIZE = np.log(BETWEEN)[:, None]
_WEIGHTS = np.column_stack([np.interp(np.log(BETWEEN), np.log(STEPS), one) for one in np.eye(9)])

# Median of the current over the buoy's [-] and standard deviation of its logarithm, before any
# depth is known; how far off the depths of the right one are: over how far the current has lifted
# the sensor [-], and one that it has not lifted [m] (decision 78)
EXPECTED, EXPECTED_SD, OF_DEPTH = 1.5, 0.2, (0.2, 0.5)

# Standard deviations over a node's displacement [-], and those of a node that rests [m]: along the
# current, across it, and upwards for the deepest node; those of the volume over the share of it
# that is lost, and of the whole [-] (decision 104)
ALONG, ACROSS, UPWARDS, OF_VOLUME = (0.26, 1.0), (0.2, 0.65), (0.26, 0.2), (0.33, 0.03)
LEAST_LIFT = 1.0  # of a depth sensor, over which its misfit counts [m]
SHARED = 0.3  # of a displacement, the share that is the mean of all nodes and not the node's own


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class NetCorrection:
    """Level 1 of the net, corrected by the depths of some nodes.

    Where a net's drag is larger than simulated, or the water at the cage faster than at the buoy,
    the net has the shape of the simulation in another current. Left out: that the whole cage moves
    further in a softer mooring, which depths do not show.
    """

    shape: FittedShapeGP  # level 1
    inputs: tuple[Input, ...]
    most_speed: float  # that level 1 was trained on [m/s]
    still: Float[np.ndarray, "node 3"]  # the net in still water [m]
    nodes: tuple[int, ...]  # of the depth sensors

    def predict(self, water: Metocean, depth: PerSensor) -> Prediction:
        """Predict the net [m]; the standard deviation is the emulator's.

        ``depth``: of the sensors' nodes by their level 2 [m].
        """
        return self.shape.predict(self.water(water, depth).features(self.inputs))

    def water(self, water: Metocean, depth: PerSensor) -> Metocean:
        """Water in which the simulated net is the true one."""
        return self._multiply(water, self.relative_current(water, depth))

    def relative_current(self, water: Metocean, depth: PerSensor) -> PerCase:
        """Current in the simulation over the buoy's [-]: the geometric mean of its posterior."""
        each = water.rows(np.tile(np.arange(len(water)), len(STEPS)))
        each = self._multiply(each, np.repeat(STEPS, len(water)))
        nodes = np.array(self.nodes)
        height = self.shape.mean_of_nodes(each.features(self.inputs), nodes)[:, :, 2]
        simulated = np.tensordot(_WEIGHTS, -height.reshape(len(STEPS), *depth.shape), axes=1)
        # Not level 2's own standard deviation: most of it is the current, shared by all sensors.
        variance = _add_squares(depth + self.still[nodes, 2], *OF_DEPTH)
        misfit = np.sum((simulated - depth) ** 2 / variance, axis=2)
        misfit += ((_SIZE - np.log(EXPECTED)) / EXPECTED_SD) ** 2
        weight = np.exp(-0.5 * (misfit - misfit.min(axis=0)))
        return np.exp(np.sum(weight * _SIZE, axis=0) / np.sum(weight, axis=0))

    def std(self, water: Metocean, net: Prediction, depth: PerSensor) -> PerNode:
        """Standard deviation of the true net about level 2, with the emulator's (x, y, z) [m].

        Where the net misses the depths that it was fitted to, no simulation in another current is
        the true net, and it may be off by as much of each displacement.

        ``net``, ``depth``: as predicted, and of the sensors' nodes by their level 2 [m].
        """
        moved, nodes = net.mean - self.still, np.array(self.nodes)
        missed = np.sum((net.mean[:, nodes, 2] + depth) ** 2, axis=1)
        lift = np.sum((depth + self.still[nodes, 2]) ** 2 + LEAST_LIFT**2, axis=1)
        misfit = np.sqrt(missed / lift)[:, None]
        flat = np.linalg.norm(moved[..., :2], axis=2)
        flat = (1.0 - SHARED) * flat + SHARED * flat.mean(axis=1, keepdims=True)
        # The nearer to the collar, which floats, the less a node goes up and down.
        lifted = self.still[:, 2] / self.still[:, 2].min() * np.linalg.norm(moved, axis=2)
        sizes = (flat, ALONG), (flat, ACROSS), (lifted, UPWARDS)
        along, across, upwards = (_add_squares(x, *own) + (misfit * x) ** 2 for x, own in sizes)
        speed = np.linalg.norm(water.current_velocity, axis=1, keepdims=True)
        share = (water.current_velocity / np.maximum(speed, 1e-9))[:, None] ** 2
        variance = share * along[..., None] + (1.0 - share) * across[..., None]
        return np.sqrt(np.concatenate([variance, upwards[..., None]], axis=2) + net.std**2)

    def _multiply(self, water: Metocean, factor: PerCase) -> Metocean:
        """Return the water with its current multiplied, as far as level 1 was trained."""
        velocity, change = water.current_velocity, water.current_change
        speed = np.linalg.norm(velocity, axis=1)
        # Water that is faster than any in the training stays as it is.
        most = np.maximum(1.0, self.most_speed / np.maximum(speed, 1e-9))
        times = np.minimum(factor, most)[:, None]
        change = None if change is None else change * times**2
        return replace(water, current_velocity=velocity * times, current_change=change)


def volume_std(fraction: PerCase) -> PerCase:
    """Standard deviation of the true volume about level 2, over that in still water [-]."""
    return np.sqrt(_add_squares(np.maximum(1.0 - fraction, 0.0), *OF_VOLUME))


def _add_squares(size: Size, share: float, rest: float) -> Size:
    return (share * size) ** 2 + rest**2
