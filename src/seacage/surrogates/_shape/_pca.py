"""Principal components of node positions: a shape as a few scores."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError
from seacage.surrogates import _gp
from seacage.surrogates._arrays import Arrays, Settings, array, setting
from seacage.surrogates._prediction import Prediction, check_inputs, check_outputs, check_shapes

RowNode3 = Float[np.ndarray, "row node 3"]
PAPER_VARIANCE = 0.93  # share of the variance that the paper keeps, in three modes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Modes:
    """Orthonormal directions of a table of shapes."""

    centre: Float[np.ndarray, " coordinate"]  # the mean shape, or zero [m]
    # One row per mode, most important first, of unit length over all coordinates
    direction: Float[np.ndarray, "mode coordinate"]
    # Root mean square of what the modes leave out, per coordinate [m]
    truncation: Float[np.ndarray, " coordinate"]

    @property
    def nodes(self) -> int:
        """Of a shape."""
        return len(self.centre) // 3

    def encode(self, shape: Float[np.ndarray, "row coordinate"]) -> Float[np.ndarray, "row mode"]:
        """Scores of each shape [m]."""
        return (shape - self.centre) @ self.direction.T

    def decode(self, score: Float[np.ndarray, "row mode"]) -> Float[np.ndarray, "row coordinate"]:
        """Shape of each row of scores [m]."""
        return self.centre + score @ self.direction

    def std(self, score_std: Float[np.ndarray, "row mode"]) -> Float[np.ndarray, "row coordinate"]:
        """Of each coordinate, from independent scores and what the modes leave out [m]."""
        return np.sqrt(score_std**2 @ self.direction**2 + self.truncation**2)

    def truncated(self, shape: Float[np.ndarray, "row coordinate"], modes: int) -> Self:
        """The first modes, with what they leave out of these shapes."""
        kept = replace(self, direction=self.direction[:modes])
        missed = shape - kept.decode(kept.encode(shape))
        return replace(kept, truncation=np.sqrt(np.mean(missed**2, axis=0)))

    def to_arrays(self) -> Arrays:
        """By the names of its parts."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, np.ndarray], *, modes: int) -> Self:
        """The other way. Raises ModelError: an array is missing, misshapen, or not finite."""
        direction = array(arrays, "direction", modes, None)
        centre, truncation = (
            array(arrays, name, direction.shape[1]) for name in ("centre", "truncation")
        )
        return cls(centre=centre, direction=direction, truncation=truncation)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OverTime:
    """The shapes at all time steps of all cases, as far as principal modes know them."""

    mean: Float[np.ndarray, " coordinate"]  # over all steps [m]
    # Mean product of two coordinates' distances from their means [m2]
    scatter: Float[np.ndarray, "coordinate coordinate"]

    @classmethod
    def of_snapshots(cls, node_position: Float[np.ndarray, "t node 3"]) -> Self:
        """Of the shapes themselves, e.g. ``History.node_position`` of all cases [m]."""
        node_position = check_outputs(
            node_position, what="OverTime", rows=len(node_position), shape="(steps, nodes, 3)"
        )
        rows = node_position.reshape(len(node_position), -1)
        mean = rows.mean(axis=0)
        return cls(mean=mean, scatter=(rows - mean).T @ (rows - mean) / len(rows))

    @classmethod
    def of_moment(
        cls,
        node_position: Float[np.ndarray, "case node 3"],
        second_moment: Float[np.ndarray, "coordinate coordinate"],
        *,
        rest_position: Float[np.ndarray, "node 3"],
    ) -> Self:
        """Of what a campaign in time keeps in place of the shapes.

        ``node_position``: means over time of all cases that the moment is of: those that converged
        [m].
        ``second_moment``: mean over time and cases of the products of displacements from the shape
        at rest [m2].
        ``rest_position``: that shape: ``cage.design_position`` for a campaign of seacage [m].
        """
        mean = node_position.reshape(len(node_position), -1).mean(axis=0)
        if second_moment.shape != (len(mean), len(mean)) or rest_position.size != len(mean):
            raise InputError(
                f"OverTime: a second moment of shape {second_moment.shape} and a shape at rest of "
                f"{rest_position.size // 3} nodes do not belong to {len(mean) // 3} nodes."
            )
        moved = mean - rest_position.ravel()
        return cls(mean=mean, scatter=second_moment - np.outer(moved, moved))


def all_modes(
    shape: Float[np.ndarray, "row coordinate"],  # one row per case [m]
    *,
    # Where the modes start, "variance" being the mean square from there; None for the mean
    about: Float[np.ndarray, " coordinate"] | None = None,
) -> tuple[Modes, Float[np.ndarray, " mode"]]:
    """Every mode of a table of shapes, and the share of the variance up to each."""
    centre = shape.mean(axis=0) if about is None else about
    _, size, direction = np.linalg.svd(shape - centre, full_matrices=False)
    return _sort_modes(centre, direction, size**2)


def modes_over_time(
    over_time: OverTime, *, about: Float[np.ndarray, " coordinate"] | None = None
) -> tuple[Modes, Float[np.ndarray, " mode"]]:
    """Every mode of the shapes at all time steps, and the share of the variance up to each."""
    centre = over_time.mean if about is None else about
    moved = over_time.mean - centre
    size, direction = np.linalg.eigh(over_time.scatter + np.outer(moved, moved))
    # Rounding can leave a hair less than nothing.
    return _sort_modes(centre, direction.T[::-1], np.maximum(size[::-1], 0.0))


def modes_within(shape: Float[np.ndarray, "row coordinate"], tolerance: float) -> Modes:
    """The fewest modes that move no node by more than the tolerance [m], root mean square."""
    modes, _ = all_modes(shape)
    held = np.mean(modes.encode(shape) ** 2, axis=0)[:, None] * modes.direction**2
    missed = np.mean((shape - modes.centre) ** 2, axis=0) - np.cumsum(held, axis=0)
    worst = missed.reshape(len(missed), -1, 3).sum(axis=2).max(axis=1)
    enough = np.flatnonzero(worst <= tolerance**2)
    return modes.truncated(shape, int(enough[0]) + 1 if len(enough) else len(worst))


def _sort_modes(
    centre: Float[np.ndarray, " coordinate"],
    direction: Float[np.ndarray, "mode coordinate"],
    size: Float[np.ndarray, " mode"],
) -> tuple[Modes, Float[np.ndarray, " mode"]]:
    share = np.cumsum(size) / max(float(np.sum(size)), np.finfo(float).tiny)
    # In C order, as they come back from a file: the same rounding in every prediction.
    direction = np.ascontiguousarray(direction)
    modes = Modes(centre=centre, direction=direction, truncation=np.zeros_like(centre))
    return modes, share


@dataclass(frozen=True, slots=True, kw_only=True)
class PcaGP:
    """A few principal scores of the shape, each its own Gaussian process; not yet fitted.

    The paper's model. Its matrix M of all nodes at all time steps of all cases gives the modes
    as eigenvectors of M M', the scores as phi' M (the paper prints M phi), their means over
    each case train the processes, and the shape is the sum over modes (the paper also sums over
    the cases); ``centred=False`` reads M M' literally.

    Source: Katsidoniotaki et al. (2025), Sci. Rep. 15:44281, Methods, "Net cage displacement data
    dimension reduction using PCA".
    """

    # How many to keep, or the share that the fewest have to explain; neither means the paper's 0.93
    modes: int | None = None
    variance: float | None = None
    # Whether the mean shape is taken out first. Otherwise M holds coordinates, or, where ``fit`` is
    # given the shape at rest, displacements from it: the paper says both
    centred: bool = True
    # As for ``GaussianProcess``
    kernel: _gp.KernelName = "squared-exponential"
    restarts: int = 3

    def __post_init__(self) -> None:
        _gp.check_options(kernel=self.kernel, restarts=self.restarts)
        if self.modes is not None and self.variance is not None:
            raise InputError("PcaGP: both modes and variance are given. Choose one of them.")
        if self.modes is not None and self.modes < 1:
            raise InputError(f"PcaGP: modes = {self.modes} keeps nothing. Give at least 1.")
        if self.variance is not None and not 0.0 < self.variance <= 1.0:
            raise InputError(
                f"PcaGP: variance = {self.variance:g} is not a share in (0, 1]. Give 0.93 for 93 %."
            )

    def fit(
        self,
        x: Float[np.ndarray, "n feature"],
        node_position: Float[np.ndarray, "n node 3"],
        *,
        over_time: OverTime | None = None,
        rest_position: Float[np.ndarray, "node 3"] | None = None,
        seed: int = 0,
    ) -> "FittedPcaGP":
        """Learn from features and shapes.

        Parameters
        ----------
        x
            One row per case.
        node_position
            The shape of each case, a mean over time [m].
        over_time
            The shapes at all time steps, for the modes to be of; without it they are of the
            cases' means.
        rest_position
            The shape at rest, for ``centred=False`` to mean displacements from it [m].
        seed
            Of the subsets of points and of the random starts.
        """
        x, node_position = check_shapes(x, node_position, what="PcaGP.fit")
        shape = node_position.reshape(len(x), -1)
        about = self._about(rest_position, coordinates=shape.shape[1])
        if over_time is None:
            modes, share = all_modes(shape, about=about)
        elif len(over_time.mean) == shape.shape[1]:
            modes, share = modes_over_time(over_time, about=about)
        else:
            raise InputError(
                f"PcaGP.fit: the shapes over time have {len(over_time.mean) // 3} nodes, those of "
                f"the cases {shape.shape[1] // 3}. Give both of the same net."
            )
        count = self._count(share)
        modes = modes.truncated(shape, count)
        scores = tuple(
            _gp.fit_process(
                _gp.StationaryKernel(self.kernel),
                x,
                score[:, None],
                restarts=self.restarts,
                seed=seed + mode,
            )
            for mode, score in enumerate(modes.encode(shape).T)
        )
        return FittedPcaGP(basis=modes, scores=scores, explained_variance=float(share[count - 1]))

    def _about(
        self, rest_position: Float[np.ndarray, "node 3"] | None, *, coordinates: int
    ) -> Float[np.ndarray, " coordinate"] | None:
        if self.centred:
            return None
        if rest_position is None:
            return np.zeros(coordinates)
        rest = check_inputs(rest_position, what="PcaGP.fit: rest_position", width=3).ravel()
        if len(rest) != coordinates:
            raise InputError(
                f"PcaGP.fit: the shape at rest has {len(rest) // 3} nodes, those of the cases "
                f"{coordinates // 3}. Give both of the same net."
            )
        return rest

    def _count(self, share: Float[np.ndarray, " mode"]) -> int:
        if self.modes is None:
            wanted = self.variance or PAPER_VARIANCE
            return min(int(np.searchsorted(share, wanted)) + 1, len(share))
        if self.modes > len(share):
            raise InputError(
                f"PcaGP.fit: modes = {self.modes}, but these cases have only {len(share)}."
            )
        return self.modes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedPcaGP:
    """Principal modes of the shape and a process for each score."""

    MODEL: ClassVar[str] = "pca-gp"

    basis: Modes  # the modes kept
    scores: tuple[_gp.FittedGaussianProcess, ...]  # one process per mode
    explained_variance: float  # share of the training variance that the modes hold

    @property
    def modes(self) -> int:
        """How many are kept."""
        return len(self.scores)

    def encode(self, node_position: RowNode3) -> Float[np.ndarray, "row mode"]:
        """Scores of shapes [m]."""
        rows = np.reshape(node_position, (len(node_position), -1))
        return self.basis.encode(check_inputs(rows, what="encode", width=len(self.basis.centre)))

    def decode(self, score: Float[np.ndarray, "row mode"]) -> RowNode3:
        """Shapes of scores [m]."""
        return self.basis.decode(score).reshape(len(score), self.basis.nodes, 3)

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """Shape at each row of features [m].

        ``x``: one row per case, the features of the training.
        ``noisy``: of a new observation: adds the noise of the scores. What the modes leave out is
        in the standard deviation either way.
        """
        answers = [score.predict(x, noisy=noisy) for score in self.scores]
        mean = np.stack([answer.mean for answer in answers], axis=1)
        std = self.basis.std(np.stack([answer.std for answer in answers], axis=1))
        return Prediction(mean=self.decode(mean), std=std.reshape(len(std), self.basis.nodes, 3))

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        scores, arrays = _gp.processes_to_arrays(self.scores)
        settings: Settings = {
            "model": self.MODEL,
            "explained_variance": self.explained_variance,
            "scores": scores,
        }
        return settings, self.basis.to_arrays() | arrays

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        scores = _gp.processes_from_arrays(settings, "scores", arrays)
        return cls(
            basis=Modes.from_arrays(arrays, modes=len(scores)),
            scores=scores,
            explained_variance=setting(settings, "explained_variance", float),
        )
