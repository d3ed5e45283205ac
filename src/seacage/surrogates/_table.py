"""A fitted model of few inputs as a table with a stated error."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isfinite, log, prod
from typing import Any, ClassVar, Protocol, Self, runtime_checkable

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import Arrays, Settings, array, setting
from seacage.surrogates._prediction import Prediction, checked_inputs
from seacage.surrogates._region import AbstractRegion, saved_region
from seacage.surrogates._spline import FEWEST, Spline, coefficient_count, nodes

START = 12
"""Nodes along each axis of the first grid."""

CHECKS = 2000
"""Random inputs at which a grid is held against the model, each round anew."""

PROBES = 250
"""Random inputs on the grid's lines along one axis, to see which axis is too coarse."""

GROWTH = (1.25, 3.0)
"""Least and most that an axis grows from one round to the next."""

ROUNDING = 1e-9
"""Share of the answers' size that a standard deviation has to reach to be worth following."""


@runtime_checkable
class Tabulable(Protocol):
    """What can be tabulated: anything that answers with and without the noise of observing."""

    def predict(self, x: Float[np.ndarray, "row feature"], /, *, noisy: bool = False) -> Prediction:
        """Answer at each row of features."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Table:
    """A fitted model of one to three inputs as cubic splines over an even grid.

    It answers as the model does, to an error that was measured when it was made, and thousands
    of times faster. Outside its region it does not answer at all.

    Parameters
    ----------
    region
        Where it answers.
    spline
        Of the means, the variances and the noise variances, in the outputs' units.
    output_shape
        Of one row's answer: () for a number.
    tolerance
        Error that was asked for, in predictive standard deviations.
    mean_error, std_error
        Largest differences from the model's mean and standard deviation that were found, in
        the model's own standard deviations, at thousands of random inputs.
    least_std
        The standard deviation below which precision was no longer asked for, by output.
    """

    MODEL: ClassVar[str] = "table"

    region: AbstractRegion
    spline: Spline
    output_shape: tuple[int, ...]
    tolerance: float
    mean_error: float
    std_error: float
    least_std: Float[np.ndarray, " output"]

    @staticmethod
    def of(
        fitted: Tabulable,
        region: AbstractRegion,
        *,
        tolerance: float = 1e-3,
        least_std: ArrayLike = 0.0,
        most_nodes: int = 100_000,
        level: int | None = None,
        seed: int = 0,
    ) -> "Table":
        """Tabulate a model, on a grid that grows until the error is small enough.

        The error is the largest difference at 2,000 random inputs, of the mean and of the
        standard deviation, in the model's standard deviations without noise. A grid that
        passes is held against 2,000 more, and the larger of the two is what it states: it is
        found, not proven.

        Parameters
        ----------
        fitted
            Any fitted model of this room, or anything that answers alike.
        region
            The inputs to cover: a ``Box``, or a ``Disc`` for currents.
        tolerance
            Largest error, in predictive standard deviations.
        least_std
            Standard deviations below this count as this much: one number, or one per output
            in its unit. A model learned without noise is nearly certain at its own cases, and
            to follow it there would take a grid as fine as certainty is sharp.
        most_nodes
            Largest size; a node takes three numbers of 8 bytes for each output.
        level
            Of a multi-level model; None is its highest.
        seed
            Of the random inputs.

        Raises
        ------
        InputError
            The tolerance cannot be met within the size.
        """
        _check_request(tolerance, most_nodes, axes=len(region.periodic))
        asked = _Asked(fitted=fitted, level=level)
        random = np.random.default_rng(seed)
        shape = (START,) * len(region.periodic)
        while True:
            table = _gridded(asked, region, shape, tolerance=tolerance, least_std=least_std)
            table = _held_against(table, asked, random)
            if table.error <= tolerance:
                table = _held_against(table, asked, random)
            if table.error <= tolerance:
                return table
            shape = _finer(table, asked, random, most_nodes=most_nodes)

    @property
    def error(self) -> float:
        """Largest error found, of mean or standard deviation, in standard deviations."""
        return max(self.mean_error, self.std_error)

    @property
    def nodes(self) -> tuple[int, ...]:
        """Of the grid, along each axis."""
        return self.spline.shape

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """Answer at each row of features, as the model would.

        Parameters
        ----------
        x
            One row per case, the features of the model.
        noisy
            Of a new observation: adds the noise.

        Raises
        ------
        InputError
            A row lies outside the table.
        """
        x = checked_inputs(x, what="Table.predict", width=self.region.width)
        fields = self.spline.at(self.region.checked_places(x, what="Table.predict"))
        outputs = len(self.least_std)
        variance = fields[:, outputs : 2 * outputs]
        if noisy:
            variance = variance + fields[:, 2 * outputs :]
        shape = (len(x), *self.output_shape)
        return Prediction(
            mean=fields[:, :outputs].reshape(shape),
            # A spline may dip below the zero that it passes close to.
            std=np.sqrt(np.maximum(variance, 0.0)).reshape(shape),
        )

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        settings: Settings = {
            "model": self.MODEL,
            "region": self.region.to_settings(),
            "nodes": list(self.nodes),
            "output_shape": list(self.output_shape),
            "tolerance": self.tolerance,
            "mean_error": self.mean_error,
            "std_error": self.std_error,
        }
        return settings, {
            "coefficients": self.spline.coefficients,
            "least_std": self.least_std,
        }

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The table that ``to_arrays`` described.

        Raises
        ------
        ModelError
            A setting or an array is missing, of another kind or shape, or not finite.
        """
        region = saved_region(setting(settings, "region", dict))
        shape = _counts(settings, "nodes", least=FEWEST)
        output_shape = _counts(settings, "output_shape", least=1)
        outputs = prod(output_shape)
        if len(shape) != len(region.periodic):
            raise ModelError(
                f"The saved table's grid has {len(shape)} axes and its region "
                f"{len(region.periodic)}. The file is damaged. Make the table again."
            )
        rows = coefficient_count(shape, region.periodic)
        coefficients = array(arrays, "coefficients", rows, 3 * outputs)
        return cls(
            region=region,
            spline=Spline(shape=shape, periodic=region.periodic, coefficients=coefficients),
            output_shape=output_shape,
            tolerance=setting(settings, "tolerance", float),
            mean_error=setting(settings, "mean_error", float),
            std_error=setting(settings, "std_error", float),
            least_std=array(arrays, "least_std", outputs),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Asked:
    """The model, and at which of its levels it is asked."""

    fitted: Tabulable
    level: int | None

    def __call__(self, x: Float[np.ndarray, "row feature"]) -> tuple[Prediction, Prediction]:
        """What lies behind an observation, and a new observation."""
        at: dict[str, Any] = {} if self.level is None else {"level": self.level}
        return self.fitted.predict(x, **at), self.fitted.predict(x, noisy=True, **at)


def _gridded(
    asked: _Asked,
    region: AbstractRegion,
    shape: tuple[int, ...],
    *,
    tolerance: float,
    least_std: ArrayLike,
) -> Table:
    """Table through the model's answers at a grid's nodes, its error not yet known."""
    quiet, noisy = asked(region.inputs(nodes(shape, region.periodic)))
    mean, std, total = (_flat(one) for one in (quiet.mean, quiet.std, noisy.std))
    fields = np.hstack([mean, std**2, total**2 - std**2])
    least = np.broadcast_to(np.ravel(np.asarray(least_std, dtype=float)), mean.shape[1:])
    return Table(
        region=region,
        spline=Spline.through(fields, shape=shape, periodic=region.periodic),
        output_shape=quiet.mean.shape[1:],
        tolerance=tolerance,
        mean_error=0.0,
        std_error=0.0,
        least_std=np.maximum(least, ROUNDING * np.abs(mean).max(axis=0)),
    )


def _held_against(table: Table, asked: _Asked, random: np.random.Generator) -> Table:
    """Table with the larger of its errors so far and at fresh random inputs."""
    mean, std = _errors(table, asked, random.uniform(size=(CHECKS, len(table.nodes))))
    return replace(
        table, mean_error=max(table.mean_error, mean), std_error=max(table.std_error, std)
    )


def _errors(
    table: Table, asked: _Asked, place: Float[np.ndarray, "row axis"]
) -> tuple[float, float]:
    x = table.region.inputs(place)
    quiet, noisy = asked(x)
    own, own_noisy = table.predict(x), table.predict(x, noisy=True)
    std = np.maximum(_flat(quiet.std), table.least_std)
    # An output that is nothing everywhere has no unit to measure its error in.
    unit = np.where(std > 0.0, std, 1.0)

    def largest(one: np.ndarray, other: np.ndarray) -> float:
        return float(np.max(np.abs(_flat(one) - _flat(other)) / unit))

    of_std = max(largest(own.std, quiet.std), largest(own_noisy.std, noisy.std))
    return largest(own.mean, quiet.mean), of_std


def _finer(
    table: Table, asked: _Asked, random: np.random.Generator, *, most_nodes: int
) -> tuple[int, ...]:
    """Grid to try next: each axis finer by what its own error asks for.

    Raises
    ------
    InputError
        The grid is as large as it may be.
    """
    axes, size = len(table.nodes), prod(table.nodes)
    errors = np.array([_error_along(axis, table, asked, random) for axis in range(axes)])
    # The error of a cubic falls with the fourth power; the axes' errors add up.
    growth = np.clip((2.0 * axes * errors / table.tolerance) ** 0.25, 1.0, GROWTH[1])
    growth = np.maximum(growth, GROWTH[0] if np.all(growth < GROWTH[0]) else 1.0)
    room = log(most_nodes / size) / log(float(np.prod(growth)))
    growth = growth ** min(1.0, room)
    shape = tuple(int(count * more) for count, more in zip(table.nodes, growth, strict=True))
    if not 1.1 * size < prod(shape) <= most_nodes:
        raise InputError(
            f"Table.of: a grid of {' x '.join(map(str, table.nodes))} nodes errs by "
            f"{table.error:.2g} predictive sd; at most {table.tolerance:g} was asked for, within "
            f"{most_nodes} nodes. Ask for less precision, allow more nodes, take a smaller "
            "region, or give the `least_std` below which precision is of no use."
        )
    return shape


def _error_along(axis: int, table: Table, asked: _Asked, random: np.random.Generator) -> float:
    """Largest error where every other coordinate is a node's, so that only this axis errs."""
    place = random.uniform(size=(PROBES, len(table.nodes)))
    for other, count in enumerate(table.nodes):
        if other != axis:
            cells = count if table.region.periodic[other] else count - 1
            place[:, other] = np.floor(place[:, other] * count) / cells
    return max(_errors(table, asked, place))


def _flat(values: Float[np.ndarray, "row *rest"]) -> Float[np.ndarray, "row output"]:
    return values.reshape(len(values), -1)


def _check_request(tolerance: float, most_nodes: int, *, axes: int) -> None:
    if not (isfinite(tolerance) and tolerance > 0.0):
        raise InputError(
            f"Table.of: tolerance = {tolerance:g} is not above 0. "
            "Give the largest error in predictive standard deviations, e.g. 1e-3."
        )
    if most_nodes < START**axes:
        raise InputError(
            f"Table.of: most_nodes = {most_nodes} is fewer than the {START**axes} of the first "
            "grid. Allow more."
        )


def _counts(settings: Mapping[str, object], name: str, *, least: int) -> tuple[int, ...]:
    counts = tuple(setting({name: one}, name, int) for one in setting(settings, name, list))
    if any(count < least for count in counts):
        raise ModelError(
            f"The saved table's {name} is {counts}. The file is damaged. Make the table again."
        )
    return counts
