"""What a twin says about a cage: loads, depths, shape, how sure it is and why not."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.surrogates import Prediction

Interval = tuple[Float[np.ndarray, "case output"], Float[np.ndarray, "case output"]]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answer:
    """The cage's response to each row of metocean input.

    A row that is not valid holds NaN in every number, and ``reason`` says why; a door writes
    such a number as nothing at all.

    Parameters
    ----------
    valid
        The input was there, passed its checks and was fresh.
    in_domain
        The input lies inside what level 1 was trained on; False means extrapolating.
    reason
        One sentence where a row is not valid or extrapolates, else "".
    bridle_names, bridle_tension, bridle_level
        Best mean and standard deviation of each bridle's tension [N], and the fidelity that
        gave them: 2 where a shackle has taught it, else 1.
    bridle_low
        The simulations alone [N].
    sensor_names, sensor_units, sensor, sensor_level
        What each sensor would read, with the scatter of its readings [N] or [m] depth. The
        standard deviation at level 2 is calibrated: mean ± 1.96 of it is to hold 95 %.
    sensor_low
        The simulations alone at the sensor's place, with the emulator's spread [N] or [m].
    node_position, shape_level
        Of the whole net [m], x east, y north, z up.
    node_sigma
        Standard deviation along the least known axis of each node [m], of the surrogate about
        the simulations: what these miss of the real net is not in it at level 1.
    volume_fraction
        Volume over the same model's volume in still water [-].
    """

    valid: Bool[np.ndarray, " case"]
    in_domain: Bool[np.ndarray, " case"]
    reason: tuple[str, ...]
    bridle_names: tuple[str, ...]
    bridle_tension: Prediction
    bridle_low: Float[np.ndarray, "case line"]
    bridle_level: Int[np.ndarray, " line"]
    sensor_names: tuple[str, ...]
    sensor_units: tuple[str, ...]
    sensor: Prediction
    sensor_low: Prediction
    sensor_level: Int[np.ndarray, " sensor"]
    node_position: Float[np.ndarray, "case node 3"]
    node_sigma: Float[np.ndarray, "case node"]
    shape_level: int
    volume_fraction: Float[np.ndarray, " case"]

    def __len__(self) -> int:
        return len(self.valid)

    def widened(
        self, *, bridle: Float[np.ndarray, " line"], sensor: Float[np.ndarray, " sensor"]
    ) -> Self:
        """Return the same with standard deviations times factors [-]; means and shape stay."""
        return replace(
            self,
            bridle_tension=replace(self.bridle_tension, std=self.bridle_tension.std * bridle),
            sensor=replace(self.sensor, std=self.sensor.std * sensor),
        )

    def bridle_interval(self, *, z: float = 1.96) -> Interval:
        """Interval of the tensions [N], mean ± z standard deviations; a rope never pushes."""
        lower, upper = _interval(self.bridle_tension, z)
        return np.maximum(lower, 0.0), upper

    def sensor_interval(self, *, z: float = 1.96) -> Interval:
        """Interval of the sensors' readings [N] or [m], mean ± z standard deviations."""
        return _interval(self.sensor, z)

    def sensor_low_interval(self, *, z: float = 1.96) -> Interval:
        """Interval of the simulations alone [N] or [m], mean ± z standard deviations."""
        return _interval(self.sensor_low, z)


def _interval(prediction: Prediction, z: float) -> Interval:
    return prediction.mean - z * prediction.std, prediction.mean + z * prediction.std
