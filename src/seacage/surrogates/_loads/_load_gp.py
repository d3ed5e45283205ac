"""Surrogate of all lines' loads in waves: mean, standard deviation, three-hour maximum, wear."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
import scipy
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.surrogates import _gp as gp
from seacage.surrogates._arrays import Arrays, Settings, array, setting_list
from seacage.surrogates._loads._case_kernel import MEAN, WAVE_EFFECT, case_inputs
from seacage.surrogates._loads._loads import EULER, LoadCases, LoadPrediction, Loads
from seacage.surrogates._prediction import Prediction, check_inputs
from seacage.surrogates._shape._symmetry import Symmetry

RowInput = Float[np.ndarray, "row input"]
RowLine = Float[np.ndarray, "row line"]
HEIGHT = 3  # feature of ``sea_features`` that holds Hs
OFFSET = 0.05  # added before a logarithm is taken, over the statistic's median [-]
# Of all cases together, as memory grows with their square; each case has as many
MOST_IMAGES = 4000
# Images that hyperparameters are learned from; all others count in the answer alone
MOST_POINTS = 1500
LEAST_HS = 1e-3  # of the training [m]
HELD = 0.95  # share of left-out cases that intervals of this level hold


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadGP:
    """Gaussian processes of lines' loads in waves, not yet fitted.

    The mean is learned as it is. Standard deviation, largest tension of three hours above the
    mean, and damage-equivalent load are learned as logarithms of their ratio to Hs, as loads grow
    with the waves and their scatter with the loads. Two times of one sea differ: a case has a
    deviation that its images have in common, and noise of each image besides.

    ``restarts``: random starts of each hyperparameter search beside the deterministic one.
    ``symmetry``: of the lines' places: every case is learned with all its images. Needs
    ``sea_features``.
    """

    restarts: int = 1
    symmetry: Symmetry | None = None

    def __post_init__(self) -> None:
        gp.check_options(restarts=self.restarts)

    def fit(
        self, x: Float[np.ndarray, "n feature"], loads: LoadCases, *, duration: float, seed: int = 0
    ) -> "FittedLoadGP":
        """Learn from features and loads.

        Parameters
        ----------
        x
            One row per case, from ``sea_features``; all with waves.
        loads
            Of each case.
        duration
            That each case's statistics are over [s].
        seed
            Of the subset of points and of the random starts.
        """
        x = check_inputs(x, what="LoadGP.fit")
        if len(x) != len(loads.mean):
            raise InputError(f"LoadGP.fit: {len(x)} rows of x but {len(loads.mean)} of loads.")
        if np.any(x[:, HEIGHT] < LEAST_HS):
            row = int(np.argmin(x[:, HEIGHT]))
            raise InputError(
                f"LoadGP.fit: row {row} has Hs = {x[row, HEIGHT]:g} m, but the scatter of loads is "
                "learned from waves. Leave cases without waves out."
            )
        above = _above_mean(loads)
        offset = {name: _offset(one) for name, one in above.items()}
        outputs = {"mean": loads.mean} | {
            name: np.log((one + offset[name]) / x[:, [HEIGHT]]) for name, one in above.items()
        }
        images, tables = draw_images(self.symmetry, x, outputs, seed=seed)
        processes = fit_tables(images, tables, restarts=self.restarts, seed=seed)
        return FittedLoadGP(
            processes=processes,
            widening={
                name: _widening(process, tables[name], images[:, -1])
                for name, process in processes.items()
            },
            offset=offset,
            scatter=_largest_scatter(self.symmetry, loads),
            wears=np.array(np.isfinite(loads.damage_equivalent).any(axis=0), dtype=np.float64),
            duration=duration,
        )


def fit_tables(
    x: RowInput,  # ``case_inputs`` of the images
    tables: Mapping[str, Float[np.ndarray, "row output"]],
    *,
    restarts: int,
    seed: int,
) -> dict[str, gp.FittedGaussianProcess]:
    """Fit a process to each table of outputs at the images of cases; "mean" is one of means."""
    return {
        name: gp.fit_process(
            MEAN if name == "mean" else WAVE_EFFECT,
            x,
            table,
            restarts=restarts,
            seed=seed,
            most=MOST_POINTS,
        )
        for name, table in tables.items()
    }


def _widening(
    process: gp.FittedGaussianProcess, table: RowLine, case: Float[np.ndarray, " row"]
) -> Float[np.ndarray, " line"]:
    """Factor on standard deviations by which intervals hold the cases that were left out.

    Where a line's loads have kinks that the process smooths, more than 5 % of cases are beyond
    1.96 standard deviations. The level of the quantile is that of conformal prediction, for as
    many cases. A line whose loads never vary has 1.
    """
    left_out = process.leave_groups_out(case)
    count = len(np.unique(case))
    level = min(1.0, HELD * (1.0 + 1.0 / count))
    known = left_out.std > 0.0
    deviate = np.where(known, np.abs(table - left_out.mean), 0.0) / np.where(known, left_out.std, 1)
    widening = np.quantile(deviate, level, axis=0) / scipy.special.ndtri(0.5 + 0.5 * HELD)
    return np.where(widening > 0.0, widening, 1.0)


def _offset(values: Float[np.ndarray, "case line"]) -> float:
    loaded = values[values > 0.0]
    return OFFSET * float(np.median(loaded)) if loaded.size else 1.0


def _above_mean(loads: LoadCases) -> dict[str, Float[np.ndarray, "case line"]]:
    """Statistics that grow with the waves, the largest above the mean [N]."""
    found = {"std": loads.std, "maximum": loads.above_mean}
    if np.isfinite(loads.damage_equivalent).any():
        found["damage"] = np.nan_to_num(loads.damage_equivalent)
    return found


def _largest_scatter(symmetry: Symmetry | None, loads: LoadCases) -> Float[np.ndarray, " line"]:
    """Gumbel scale of the largest value over its mean height above the mean, of each line [-]."""
    height = loads.expected - loads.mean
    share = (loads.expected - loads.most_probable) / np.where(height > 0.0, height, np.nan) / EULER
    if symmetry is not None:
        share = np.concatenate([share[:, source] for source in symmetry.source])
    known = np.isfinite(share).any(axis=0)
    return np.where(known, np.nanmedian(np.where(known, share, 0.0), axis=0), 0.0)


def draw_images(
    symmetry: Symmetry | None,
    x: Float[np.ndarray, "n feature"],
    outputs: Mapping[str, Float[np.ndarray, "n line"]],
    *,
    seed: int,
) -> tuple[RowInput, dict[str, RowLine]]:
    """All images of each case, image by image, or as many as there may be, drawn at random.

    Returns their ``case_inputs``, with the number of the case, and their outputs.
    """
    number = np.arange(len(x), dtype=float)
    if symmetry is None:
        return case_inputs(x, number), dict(outputs)
    each = min(len(symmetry), max(1, MOST_IMAGES // len(x)))
    order = np.random.default_rng(seed).random((len(x), len(symmetry))).argsort(axis=1)
    cases = [np.flatnonzero(np.any(order[:, :each] == n, axis=1)) for n in range(len(symmetry))]
    turned = [
        case_inputs(symmetry.turned(x[some], image), number[some])
        for image, some in enumerate(cases)
    ]
    return np.concatenate(turned), {
        name: np.concatenate(
            [one[some][:, symmetry.source[image]] for image, some in enumerate(cases)]
        )
        for name, one in outputs.items()
    }


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedLoadGP:
    """Processes of lines' loads in waves."""

    MODEL: ClassVar[str] = "loads"

    # By statistic: "mean" [N], and the logarithms of "std", "maximum" (above the mean) and, where
    # any line has a T-N curve, "damage", over Hs
    processes: Mapping[str, gp.FittedGaussianProcess]
    # By the same names, factor on each line's standard deviation, from cases left out [-]
    widening: Mapping[str, Float[np.ndarray, " line"]]
    offset: Mapping[str, float]  # added to a statistic before its logarithm was taken [N]
    # Gumbel scale of the largest value over its mean height above the mean, of each line [-]
    scatter: Float[np.ndarray, " line"]
    wears: Float[np.ndarray, " line"]  # 1 for a line with a T-N curve, 0 for one without [-]
    duration: float  # that the statistics of the training are over [s]

    def predict(
        self,
        x: Float[np.ndarray, "row feature"],
        *,
        hs: Float[np.ndarray, " row"] | None = None,
        duration: float = 1800.0,
        spread: bool = True,
    ) -> Loads:
        """Loads at each row of features.

        Parameters
        ----------
        x
            From ``sea_features``.
        hs
            Where the waves are lower than in ``x``, which scales their effect; None where they
            are not [m].
        duration
            Over which mean, standard deviation and wear are asked for: the shorter, the more
            they scatter from one time to another [s].
        spread
            Whether standard deviations are wanted: without them they are NaN, and the answer
            costs a small part.
        """
        height = x[:, [HEIGHT]] if hs is None else hs[:, None]
        share, lone = (self.duration / duration, 0.0) if spread else (None, None)
        inputs = case_inputs(x)
        mean, std = self._answer("mean", inputs, noise=share)
        mean = np.maximum(mean, 0.0)  # a line never pushes
        calm = np.zeros_like(mean)

        def above(
            name: str, base: np.ndarray, gumbel: np.ndarray, noise: float | None
        ) -> LoadPrediction:
            log, spread = self._answer(name, inputs, noise=noise)
            return LoadPrediction(
                base=base,
                size=height * np.exp(log),
                log_std=spread,
                gumbel=gumbel,
                offset=self.offset[name],
            )

        wear = std_load = above("std", calm, calm, share)
        if self.wears.any():
            wear = above("damage", calm, calm, share)
        return Loads(
            mean=Prediction(mean=mean, std=std),
            std=std_load,
            maximum_3h=above("maximum", mean, calm + self.scatter, lone),
            damage_equivalent=replace(wear, size=np.where(self.wears, wear.size, np.nan)),
        )

    def _answer(self, name: str, x: RowInput, *, noise: float | None) -> tuple[RowLine, RowLine]:
        """Mean, and standard deviation with so much of the training's noise variance.

        ``noise``: None for means alone.
        """
        process = self.processes[name]
        if noise is None:
            mean = process.mean(x)
            return mean, np.full_like(mean, np.nan)
        found = process.predict(x)
        # A ``CaseKernel`` has the log variance that the images of a case have in common at the end.
        of_case = math.exp(process.posterior.log_parameters[-1]) * process.amplitude**2
        behind = np.maximum(found.std**2 - of_case, 0.0)
        std = np.sqrt(behind + noise * (of_case + process.noise_at(x)))
        return found.mean, self.widening[name] * std

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs."""
        settings, arrays = gp.processes_to_arrays(list(self.processes.values()))
        own = {"model": self.MODEL, "statistics": list(self.processes), "processes": settings}
        return own, arrays | {
            "widening": np.stack(list(self.widening.values())),
            "offset": np.array(list(self.offset.values())),
            "scatter": self.scatter,
            "wears": self.wears,
            "duration": np.array([self.duration]),
        }

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        names = setting_list(settings, "statistics", str)
        processes = gp.processes_from_arrays(settings, "processes", arrays, later=True)
        lines = len(processes[0].centre)
        offset = array(arrays, "offset", len(names) - 1).tolist()
        widening = array(arrays, "widening", len(names), lines)
        return cls(
            processes=dict(zip(names, processes, strict=True)),
            widening=dict(zip(names, widening, strict=True)),
            offset=dict(zip(names[1:], offset, strict=True)),
            scatter=array(arrays, "scatter", lines),
            wears=array(arrays, "wears", lines),
            duration=float(array(arrays, "duration", 1)[0]),
        )
