"""A fitted model of few inputs as a table with a stated error."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import isfinite, log, prod
from typing import ClassVar, Protocol, Self, runtime_checkable

import numpy as np
from jaxtyping import Float
from numpy.typing import ArrayLike

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import Arrays, Settings, array, setting, setting_list
from seacage.surrogates._prediction import Prediction, Predicts, check_inputs
from seacage.surrogates._tables._region import AbstractRegion, restore_region
from seacage.surrogates._tables._spline import FEWEST, Spline, coefficient_counts, nodes

START = 12  # nodes along each axis of the first grid
CHECKS = 2000  # random inputs at which a grid is held against the model, each round anew
PROBES = 250  # random inputs on the grid's lines along one axis, to see which axis is too coarse
GROWTH = (1.25, 3.0)  # least and most that an axis grows from one round to the next
# Share of the answers' size that a standard deviation has to reach to be worth following
ROUNDING = 1e-9
_PRECISION = ("tolerance", "std_tolerance", "mean_error", "std_error")  # as saved

RowAxis = Float[np.ndarray, "row axis"]
# Answers of a model without and with noise; twice the same one where noise is not asked for
Query = Callable[[Float[np.ndarray, "row feature"]], tuple[Prediction, Prediction]]


@runtime_checkable
class Tabulable(Protocol):
    """What a table takes with its noise: anything that answers as a fitted model does."""

    def predict(self, x: Float[np.ndarray, "row feature"], /, *, noisy: bool = False) -> Prediction:
        """Answer at each row of features."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Table:
    """A fitted model of one to three inputs as cubic splines over an even grid.

    It answers as the model does, to an error that was measured when it was made, and thousands
    of times faster. Outside its region it does not answer at all.
    """

    MODEL: ClassVar[str] = "table"

    region: AbstractRegion  # where it answers
    spline: Spline  # of the means, the variances and, where it was asked for, the noise's variances
    output_shape: tuple[int, ...]  # of one row's answer: () for a number
    # Errors of the mean and of the standard deviation that were asked for, in predictive standard
    # deviations
    tolerance: float
    std_tolerance: float
    # Largest differences from the model's mean and standard deviation that were found, in the
    # model's own standard deviations, at thousands of random inputs
    mean_error: float
    std_error: float
    # The standard deviation below which precision was no longer asked for, by output
    least_std: Float[np.ndarray, " output"]

    @staticmethod
    def of(
        fitted: Tabulable | Predicts,
        region: AbstractRegion,
        *,
        tolerance: float = 1e-3,
        std_tolerance: float | None = None,
        least_std: ArrayLike = 0.0,
        most_nodes: int = 100_000,
        level: int | None = None,
        noise: bool = True,
        seed: int = 0,
    ) -> "Table":
        """Tabulate a model, on a grid that grows until the error is small enough.

        The error is the largest difference at 2,000 random inputs, of the mean and of the
        standard deviation, in the model's standard deviations without noise. A grid that
        passes is held against 2,000 more, and the larger of the two is what it states: it is
        found, not proven.

        Raises InputError: the tolerance cannot be met within the size.

        Parameters
        ----------
        fitted
            Any fitted model of this room, or anything that answers alike.
        region
            The inputs to cover: a ``Box``, or a ``Disc`` for currents.
        tolerance
            Largest error of the mean, in predictive standard deviations.
        std_tolerance
            Largest error of the standard deviation, in itself; None is as the mean's.
        least_std
            Standard deviations below this count as this much: one number, or one per output
            in its unit. A model learned without noise is nearly certain at its own cases, and
            to follow it there would take a grid as fine as certainty is sharp.
        most_nodes
            Largest size; a node takes two or three numbers of 8 bytes for each output.
        level
            Of a multi-level model; None is its highest.
        noise
            Tabulate the noise too, so that ``noisy=True`` can be asked; not every model has it.
        seed
            Of the random inputs.
        """
        std_tolerance = tolerance if std_tolerance is None else std_tolerance
        shape = (START,) * len(region.periodic)
        for one in (tolerance, std_tolerance):
            if not (isfinite(one) and one > 0.0):
                raise InputError(
                    f"Table.of: tolerance = {one:g} is not above 0. "
                    "Give the largest error in predictive standard deviations, e.g. 1e-3."
                )
        if most_nodes < prod(shape):
            raise InputError(
                f"Table.of: most_nodes = {most_nodes} is fewer than the {prod(shape)} of the "
                "first grid. Allow more."
            )
        predict: Callable[..., Prediction] = fitted.predict
        at = {} if level is None else {"level": level}

        def query(x: Float[np.ndarray, "row feature"]) -> tuple[Prediction, Prediction]:
            quiet = predict(x, **at)
            return quiet, predict(x, noisy=True, **at) if noise else quiet

        random = np.random.default_rng(seed)
        while True:
            table = _tabulate(query, region, shape, least_std=least_std)
            table = replace(table, tolerance=tolerance, std_tolerance=std_tolerance)
            for _ in range(2):
                errors = _errors(table, query, random.uniform(size=(CHECKS, len(shape))))
                mean, std = map(max, (table.mean_error, table.std_error), errors)
                table = replace(table, mean_error=mean, std_error=std)
                if table.excess > 1.0:
                    break
            else:
                return table
            shape = _finer(table, query, random, most_nodes=most_nodes)

    @property
    def excess(self) -> float:
        """The larger of its errors, each over what was asked for; a finished one's is below 1."""
        return max(self.mean_error / self.tolerance, self.std_error / self.std_tolerance)

    @property
    def has_noise(self) -> bool:
        """Whether it can answer of a new observation."""
        return self.spline.coefficients.shape[1] == 3 * len(self.least_std)

    @property
    def nodes(self) -> tuple[int, ...]:
        """Of the grid, along each axis."""
        return self.spline.shape

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """Answer at each row of features, as the model would.

        Raises InputError: a row lies outside the table, or it has no noise.

        ``x``: one row per case, the features of the model.
        ``noisy``: of a new observation: adds the noise.
        """
        if noisy and not self.has_noise:
            raise InputError(
                "Table.predict: this table was made without noise. "
                "Make it with `noise=True`, or ask what lies behind an observation."
            )
        x = check_inputs(x, what="Table.predict", width=self.region.width)
        fields = self.spline.at(self.region.check_places(x, what="Table.predict"))
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
            "noise": self.has_noise,
            **{name: getattr(self, name) for name in _PRECISION},
        }
        return settings, {"coefficients": self.spline.coefficients, "least_std": self.least_std}

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The table that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        region = restore_region(setting(settings, "region", dict))
        shape = _counts(settings, "nodes", least=FEWEST)
        output_shape = _counts(settings, "output_shape", least=1)
        outputs = prod(output_shape)
        if len(shape) != len(region.periodic):
            raise ModelError(
                f"The saved table's grid has {len(shape)} axes and its region "
                f"{len(region.periodic)}. The file is damaged. Make the table again."
            )
        rows = prod(coefficient_counts(shape, region.periodic))
        fields = (2 + setting(settings, "noise", bool)) * outputs
        coefficients = array(arrays, "coefficients", rows, fields)
        return cls(
            region=region,
            spline=Spline(shape=shape, periodic=region.periodic, coefficients=coefficients),
            output_shape=output_shape,
            **{name: setting(settings, name, float) for name in _PRECISION},
            least_std=array(arrays, "least_std", outputs),
        )


def _tabulate(
    query: Query, region: AbstractRegion, shape: tuple[int, ...], *, least_std: ArrayLike
) -> Table:
    """Table through the model's answers at a grid's nodes, its errors not yet known."""
    quiet, noisy = query(region.inputs(nodes(shape, region.periodic)))
    mean, std, total = (_flat(one) for one in (quiet.mean, quiet.std, noisy.std))
    fields = np.hstack([mean, std**2] + [total**2 - std**2] * (noisy is not quiet))
    least = np.broadcast_to(np.ravel(np.asarray(least_std, dtype=float)), mean.shape[1:])
    return Table(
        region=region,
        spline=Spline.through(fields, shape=shape, periodic=region.periodic),
        output_shape=quiet.mean.shape[1:],
        tolerance=1.0,
        std_tolerance=1.0,
        mean_error=0.0,
        std_error=0.0,
        least_std=np.maximum(least, ROUNDING * np.abs(mean).max(axis=0)),
    )


def _errors(table: Table, query: Query, place: RowAxis) -> tuple[float, float]:
    x = table.region.inputs(place)
    quiet, noisy = query(x)
    own, own_noisy = table.predict(x), table.predict(x, noisy=table.has_noise)
    std = np.maximum(_flat(quiet.std), table.least_std)
    # An output that is nothing everywhere has no unit to measure its error in.
    unit = np.where(std > 0.0, std, 1.0)

    def largest(one: np.ndarray, other: np.ndarray) -> float:
        return float(np.max(np.abs(_flat(one) - _flat(other)) / unit))

    of_std = max(largest(own.std, quiet.std), largest(own_noisy.std, noisy.std))
    return largest(own.mean, quiet.mean), of_std


def _finer(
    table: Table, query: Query, random: np.random.Generator, *, most_nodes: int
) -> tuple[int, ...]:
    """Grid to try next: each axis finer by what its own error asks for.

    Raises InputError: the grid is as large as it may be.
    """
    axes, size = len(table.nodes), prod(table.nodes)
    excess = np.array([_excess_along(axis, table, query, random) for axis in range(axes)])
    # The error of a cubic falls with the fourth power; the axes' errors add up.
    growth = np.clip((2.0 * axes * excess) ** 0.25, 1.0, GROWTH[1])
    growth = np.maximum(growth, GROWTH[0] if np.all(growth < GROWTH[0]) else 1.0)
    room = log(most_nodes / size) / log(float(np.prod(growth)))
    growth = growth ** min(1.0, room)
    shape = tuple(int(count * more) for count, more in zip(table.nodes, growth, strict=True))
    if not 1.1 * size < prod(shape) <= most_nodes:
        raise InputError(
            f"Table.of: a grid of {' x '.join(map(str, table.nodes))} nodes errs by "
            f"{table.mean_error:.2g} predictive sd in the mean and {table.std_error:.2g} in the "
            f"sd; at most {table.tolerance:g} and {table.std_tolerance:g} were asked for, within "
            f"{most_nodes} nodes. Ask for less precision, allow more nodes, take a smaller "
            "region, or give the `least_std` below which precision is of no use."
        )
    return shape


def _excess_along(axis: int, table: Table, query: Query, random: np.random.Generator) -> float:
    """Excess where every other coordinate is a node's, so that only this axis errs."""
    place = random.uniform(size=(PROBES, len(table.nodes)))
    for other, count in enumerate(table.nodes):
        if other != axis:
            cells = count if table.region.periodic[other] else count - 1
            place[:, other] = np.floor(place[:, other] * count) / cells
    mean_error, std_error = _errors(table, query, place)
    return replace(table, mean_error=mean_error, std_error=std_error).excess


def _flat(values: Float[np.ndarray, "row *rest"]) -> Float[np.ndarray, "row output"]:
    return values.reshape(len(values), -1)


def _counts(settings: Mapping[str, object], name: str, *, least: int) -> tuple[int, ...]:
    counts = setting_list(settings, name, int)
    if any(count < least for count in counts):
        raise ModelError(
            f"The saved table's {name} is {counts}. The file is damaged. Make the table again."
        )
    return counts
