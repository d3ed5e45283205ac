"""The whole shape of the net from one shared kernel."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import Arrays, Settings, joined, sub_settings, within
from seacage.surrogates._gaussian_process import (
    FittedGaussianProcess,
    check_restarts,
    condensed,
    fitted_process,
)
from seacage.surrogates._kernels import KernelName, kernel_named
from seacage.surrogates._pca import Modes, all_modes, modes_from_arrays, modes_to_arrays
from seacage.surrogates._prediction import Prediction, checked_inputs, checked_outputs


@dataclass(frozen=True, slots=True, kw_only=True)
class ShapeGP:
    """One Gaussian process for all node coordinates, not yet fitted.

    All coordinates share one kernel and one factorisation, so principal components are no
    model here but compression: as many are kept as the tolerance asks for.

    Parameters
    ----------
    kernel
        Matern-5/2 by default: lines going slack and ropes stiffening put kinks in the shape.
    tolerance
        Largest root mean square distance that compression may move any node by, over the
        training cases [m].
    restarts
        Random starts of the hyperparameter search beside the deterministic one.
    """

    kernel: KernelName = "matern-5/2"
    tolerance: float = 1e-3
    restarts: int = 3

    def __post_init__(self) -> None:
        kernel_named(self.kernel)
        check_restarts(self.restarts)
        if not self.tolerance > 0.0:
            raise InputError(
                f"ShapeGP: tolerance = {self.tolerance:g} m is not above 0. "
                "Give the distance that compression may move a node by, e.g. 0.001 m."
            )

    def fit(
        self,
        x: Float[np.ndarray, "n feature"],
        node_position: Float[np.ndarray, "n node 3"],
        *,
        seed: int = 0,
    ) -> "FittedShapeGP":
        """Learn from features and shapes.

        Parameters
        ----------
        x
            One row per case, e.g. from ``current_features``.
        node_position
            The shape of each case [m].
        seed
            Of the subset of points and of the random starts.
        """
        x = checked_inputs(x, what="ShapeGP.fit")
        node_position = checked_outputs(
            node_position, what="ShapeGP.fit", rows=len(x), shape="(rows, nodes, 3)"
        )
        shape = node_position.reshape(len(x), -1)
        modes = _within_tolerance(shape, self.tolerance)
        scores = modes.encode(shape)
        process = fitted_process(
            kernel_named(self.kernel),
            x,
            scores,
            taught_by=condensed(scores),
            restarts=self.restarts,
            seed=seed,
        )
        return FittedShapeGP(basis=modes, scores=process)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedShapeGP:
    """The whole shape: compressed modes, and one process for all their scores.

    Parameters
    ----------
    basis
        The modes kept.
    scores
        One process with an output per mode.
    """

    MODEL: ClassVar[str] = "shape-gp"

    basis: Modes
    scores: FittedGaussianProcess

    @property
    def modes(self) -> int:
        """How many the compression keeps."""
        return len(self.basis.direction)

    @property
    def compression_error_m(self) -> float:
        """Root mean square distance that compression moves the worst node by, in training [m]."""
        missed = self.basis.truncation.reshape(-1, 3)
        return float(np.sqrt(np.max(np.sum(missed**2, axis=1))))

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """Shape at each row of features [m].

        Parameters
        ----------
        x
            One row per case, the features of the training.
        noisy
            Of a new observation: adds the noise. What compression leaves out is in the
            standard deviation either way.
        """
        score = self.scores.predict(x, noisy=noisy)
        mean, std = self.basis.decode(score.mean), self.basis.std(score.std)
        shape = (len(mean), self.basis.nodes, 3)
        return Prediction(mean=mean.reshape(shape), std=std.reshape(shape))

    def coordinate(self, node: int, axis: int) -> "FittedCoordinate":
        """One coordinate of one node, answered without the rest of the shape.

        Parameters
        ----------
        node
            From 0.
        axis
            0 east, 1 north, 2 up.
        """
        nodes = self.basis.nodes
        if not (0 <= node < nodes and 0 <= axis < 3):
            raise InputError(
                f"coordinate: node {node}, axis {axis} does not exist; this shape has {nodes} "
                "nodes, from 0, and the axes 0, 1 and 2."
            )
        place = 3 * node + axis
        process = self.scores.combined(self.basis.direction[:, place])
        return FittedCoordinate(
            process=replace(process, centre=process.centre + self.basis.centre[place]),
            truncation=float(self.basis.truncation[place]),
        )

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs, as plain values and float64 arrays."""
        settings, arrays = self.scores.to_arrays()
        saved: Settings = {"model": self.MODEL, "scores": [settings]}
        return saved, modes_to_arrays(self.basis) | joined([arrays])

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described.

        Raises
        ------
        ModelError
            A setting or an array is missing, of another kind or shape, or not finite.
        """
        parts = sub_settings(settings, "scores")
        if len(parts) != 1:
            raise ModelError(f"The saved ShapeGP holds {len(parts)} processes; expected 1.")
        scores = FittedGaussianProcess.from_arrays(parts[0], within(0, arrays))
        return cls(basis=modes_from_arrays(arrays, modes=len(scores.centre)), scores=scores)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedCoordinate:
    """One coordinate of one node; it shares the shape's factor and is not saved by itself.

    Parameters
    ----------
    process
        Of the coordinate, from the compressed modes [m].
    truncation
        Root mean square of what the modes leave out [m].
    """

    process: FittedGaussianProcess
    truncation: float

    def predict(self, x: Float[np.ndarray, "row feature"], *, noisy: bool = False) -> Prediction:
        """The coordinate at each row of features, as the whole shape would answer [m]."""
        answer = self.process.predict(x, noisy=noisy)
        return Prediction(mean=answer.mean, std=np.hypot(answer.std, self.truncation))


def _within_tolerance(shape: Float[np.ndarray, "row coordinate"], tolerance: float) -> Modes:
    """The fewest modes that move no node by more than the tolerance, root mean square."""
    modes, _ = all_modes(shape)
    held = np.mean(modes.encode(shape) ** 2, axis=0)[:, None] * modes.direction**2
    missed = np.mean((shape - modes.centre) ** 2, axis=0) - np.cumsum(held, axis=0)
    worst = missed.reshape(len(missed), -1, 3).sum(axis=2).max(axis=1)
    enough = np.flatnonzero(worst <= tolerance**2)
    return modes.truncated(shape, int(enough[0]) + 1 if len(enough) else len(worst))
