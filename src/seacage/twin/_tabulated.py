"""A twin whose only input is the current, as one table: a whole winter in seconds."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError
from seacage.surrogates import Disc, Prediction, Table
from seacage.twin._metocean import Metocean
from seacage.twin._twin import Twin

LEAST_TENSION_STD = 50.0
# Standard deviations that no instrument here resolves [N], [m]: smaller ones count as these
LEAST_DEPTH_STD = 0.01

# Rows that the twin predicts at once: it makes every node of the net for each of them
ROWS_AT_ONCE = 4096


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Loads:
    """Loads of a tabulated twin: an ``Answer`` without the shape.

    A row that is not valid holds NaN in every number.
    """

    valid: Bool[np.ndarray, " case"]  # the input was known
    in_domain: Bool[np.ndarray, " case"]  # the input lies inside what level 1 was trained on
    # Best mean and standard deviation of each bridle's tension, and the simulations alone [N]
    bridle_tension: Prediction
    bridle_low: Float[np.ndarray, "case line"]
    # What each sensor would read with the scatter of its readings, and the simulations alone with
    # the emulator's spread [N] or [m] depth
    sensor: Prediction
    sensor_low: Prediction

    def __len__(self) -> int:
        return len(self.valid)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TabulatedTwin:
    """The bridles and the sensors of a twin, both levels, from one table of the current.

    Beyond the table, where the twin extrapolates, the twin itself predicts.
    """

    twin: Twin  # that the table was made of
    # Of the bridles at level 1 and at their best, of the sensors at level 1 and at their best, one
    # output for each; tensions before they are held to what a rope can carry
    table: Table

    @classmethod
    def of(
        cls,
        twin: Twin,
        *,
        tolerance: float = 1e-2,
        std_tolerance: float = 0.05,
        least_tension_std: float = LEAST_TENSION_STD,
        least_depth_std: float = LEAST_DEPTH_STD,
        most_nodes: int = 100_000,
    ) -> Self:
        """Tabulate a twin over every current that level 1 was trained on.

        Raises InputError: the twin has waves as an input too, or the tolerance cannot be met.

        Parameters
        ----------
        twin
            Whose inputs are the current alone.
        tolerance, std_tolerance
            Largest error of a mean in predictive standard deviations, and of a standard
            deviation in itself.
        least_tension_std, least_depth_std
            Standard deviations below these count as these [N], [m]: a simulator is emulated
            with almost no variance close to its own cases, more sharply than any sensor sees.
        most_nodes
            Largest size; a node takes 0.64 kB for 12 bridles and 8 sensors.
        """
        inputs = twin.models.inputs
        if inputs != ("current",):
            raise InputError(
                f"tabulated: the inputs of this twin are {' and '.join(inputs)}; a table holds the "
                "current alone. Use the twin itself, or train one with inputs=('current',)."
            )
        bridles = [least_tension_std] * len(twin.bridle_names)
        sensors = [least_depth_std] * len(twin.cage.depth_sensors)
        sensors += [least_tension_std] * len(twin.cage.shackles)
        table = Table.of(
            _DirectTwin(twin=twin),
            Disc(radius=twin.models.edge[0]),
            tolerance=tolerance,
            std_tolerance=std_tolerance,
            least_std=bridles + bridles + sensors + sensors,
            most_nodes=most_nodes,
            noise=False,
        )
        return cls(twin=twin, table=table)

    def predict(self, metocean: Metocean) -> Loads:
        """Predict in each row of water; a row without a current is not valid.

        Two million rows take a gigabyte: predict a long record day by day.
        """
        x = metocean.features(("current",))
        valid = metocean.known(("current",))
        inside = valid.copy()
        inside[valid] = self.table.region.contains(x[valid])
        mean, std = np.full((2, len(x), *self.table.output_shape), np.nan)
        beyond = valid & ~inside
        for rows, model in ((inside, self.table), (beyond, _DirectTwin(twin=self.twin))):
            if rows.any():
                part = model.predict(x[rows])
                mean[rows], std[rows] = part.mean, part.std
        lines, sensors = len(self.twin.bridle_names), len(self.twin.sensor_names)
        ends = np.cumsum([lines, lines, sensors])
        columns = zip(*(np.split(one, ends, axis=1) for one in (mean, std)), strict=True)
        low, best, sensor_low, sensor = (Prediction(mean=mean, std=std) for mean, std in columns)
        return Loads(
            valid=valid,
            in_domain=inside,
            # A rope never pushes, though a Gaussian has negative values.
            bridle_tension=replace(best, mean=np.maximum(best.mean, 0.0)),
            bridle_low=np.maximum(low.mean, 0.0),
            sensor=sensor,
            sensor_low=sensor_low,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _DirectTwin:
    """The twin as a model of the current's features, smooth where a rope goes slack."""

    twin: Twin

    def predict(self, x: Float[np.ndarray, "row feature"], /) -> Prediction:
        starts = range(0, len(x), ROWS_AT_ONCE)
        return Prediction.joined(*(self._block(x[one : one + ROWS_AT_ONCE]) for one in starts))

    def _block(self, x: Float[np.ndarray, "row feature"]) -> Prediction:
        water = replace(Metocean.from_columns({}, len(x)), current_velocity=x[:, 1:])
        answer, low = self.twin.predict(water), self.twin.models.bridles.predict(x)
        # The best mean of each tension, also where a rope that goes slack holds it at zero.
        best = Prediction(mean=low.mean.copy(), std=answer.bridle_tension.std)
        for shackle in self.twin.cage.shackles:
            if answer.bridle_level[shackle.bridle] > 1:
                column = answer.sensor_names.index(shackle.name)
                best.mean[:, shackle.bridle] = answer.sensor.mean[:, column]
        parts = low, best, answer.sensor_low, answer.sensor
        return Prediction(
            mean=np.hstack([one.mean for one in parts]), std=np.hstack([one.std for one in parts])
        )
