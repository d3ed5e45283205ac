"""Surrogate of how far the nodes of a net move in waves: standard deviations of their places."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from jaxtyping import Float

from seacage.surrogates._arrays import Arrays, Settings, array
from seacage.surrogates._gp import FittedGaussianProcess, processes_from_arrays, processes_to_arrays
from seacage.surrogates._loads._case_kernel import case_inputs
from seacage.surrogates._loads._load_gp import HEIGHT, OFFSET, draw_images, fit_tables
from seacage.surrogates._shape._symmetry import Symmetry

LEFT_OUT = 1e-2  # share of the logarithms' variance that the modes may leave out [-]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FittedMotionGP:
    """Processes of nodes' motion in waves: modes of the logarithm of their motion over Hs."""

    MODEL: ClassVar[str] = "motion"

    process: FittedGaussianProcess  # of the modes' coefficients
    # Mean logarithm of each node's horizontal motions, and then of the vertical ones
    centre: Float[np.ndarray, " quantity"]
    mode: Float[np.ndarray, "mode quantity"]  # shapes of the logarithms
    offset: float  # added to a motion before its logarithm was taken [m]

    @classmethod
    def fit(
        cls,
        x: Float[np.ndarray, "n feature"],
        std: Float[np.ndarray, "n node 3"],
        *,
        symmetry: Symmetry | None = None,
        restarts: int = 1,
        seed: int = 0,
    ) -> Self:
        """Learn from features and standard deviations.

        ``x``, ``restarts``, ``seed``: as for ``LoadGP``.
        ``std``: of each node's place, east, north and up [m].
        ``symmetry``: of the nodes: every case is learned with all its images.
        """
        # A turn of the sea leaves these two as they are, where it would mix east and north
        motion = {"across": np.hypot(std[..., 0], std[..., 1]), "up": std[..., 2]}
        offset = OFFSET * float(np.median(np.concatenate(list(motion.values()))))
        logs = {name: np.log((one + offset) / x[:, [HEIGHT]]) for name, one in motion.items()}
        rows, tables = draw_images(symmetry, x, logs, seed=seed)
        table = np.concatenate(list(tables.values()), axis=1)
        centre = table.mean(axis=0)
        values, vectors = np.linalg.eigh((table - centre).T @ (table - centre))
        left_out = np.cumsum(np.maximum(values, 0.0)) / values.sum()
        mode = vectors[:, left_out > LEFT_OUT].T[::-1]
        coefficients = {"process": (table - centre) @ mode.T}
        processes = fit_tables(rows, coefficients, restarts=restarts, seed=seed)
        return cls(**processes, centre=centre, mode=mode, offset=offset)

    def mean(
        self, x: Float[np.ndarray, "row feature"], *, hs: Float[np.ndarray, " row"]
    ) -> Float[np.ndarray, "row node 2"]:
        """Standard deviations of each node's place, horizontally and upwards [m].

        The horizontal one is the root of both axes' variances together.

        ``x``: from ``sea_features``.
        ``hs``: wave height where it is lower than in ``x``, else the same [m].
        """
        coefficients = self.process.mean(case_inputs(x)).reshape(len(x), len(self.mode))
        log = self.centre + coefficients @ self.mode
        motion = np.maximum(x[:, [HEIGHT]] * np.exp(log) - self.offset, 0.0)
        scaled = motion * (hs / x[:, HEIGHT])[:, None]
        return np.stack(np.split(scaled, 2, axis=1), axis=-1)

    def to_arrays(self) -> tuple[Settings, Arrays]:
        """Everything that ``from_arrays`` needs."""
        settings, arrays = processes_to_arrays([self.process])
        own = {"centre": self.centre, "mode": self.mode, "offset": np.array([self.offset])}
        return {"model": self.MODEL, "processes": settings}, arrays | own

    @classmethod
    def from_arrays(cls, settings: Mapping[str, object], arrays: Mapping[str, np.ndarray]) -> Self:
        """The model that ``to_arrays`` described; ``ModelError`` where it is damaged."""
        (process,) = processes_from_arrays(settings, "processes", arrays, later=True)
        centre = array(arrays, "centre", None)
        return cls(
            process=process,
            centre=centre,
            mode=array(arrays, "mode", len(process.centre), len(centre)),
            offset=float(array(arrays, "offset", 1)[0]),
        )
