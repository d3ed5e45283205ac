"""Surrogate of how lines' loads change where one has parted, from the same seas and waves."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.surrogates._gp import FittedGaussianProcess
from seacage.surrogates._loads._case_kernel import case_inputs
from seacage.surrogates._loads._load_gp import HEIGHT, draw_images, fit_tables
from seacage.surrogates._loads._loads import LoadCases
from seacage.surrogates._shape._symmetry import Symmetry


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LoadChange:
    """Gaussian processes of the change of lines' loads in waves.

    Both sides of the change are simulated in the same waves, so that what those did by chance
    falls out of it.
    """

    mean: FittedGaussianProcess  # of what the mean changes by [N]
    # Of what the expected largest of three hours, above the mean, changes by over Hs [N/m]
    maximum: FittedGaussianProcess
    state: FittedGaussianProcess  # of other quantities of the state after the change, as they are

    @classmethod
    def fit(
        cls,
        x: Float[np.ndarray, "n feature"],
        before: LoadCases,
        after: LoadCases,
        state: Float[np.ndarray, "n quantity"],
        *,
        symmetry: Symmetry | None = None,
        restarts: int = 1,
        seed: int = 0,
    ) -> Self:
        """Learn from features, loads before and after, and quantities of the state after.

        ``x``, ``restarts``, ``seed``: as for ``LoadGP``.
        ``before``, ``after``: loads of each case, in the same waves.
        ``state``: what else is wanted of the state after; images leave it as it is.
        ``symmetry``: images that leave the change as it is, as a mirror through the parted line.
        """
        outputs = {
            "mean": after.mean - before.mean,
            "maximum": (after.above_mean - before.above_mean) / x[:, [HEIGHT]],
        }
        rows, tables = draw_images(symmetry, x, outputs, seed=seed)
        tables["state"] = state[rows[:, -1].astype(int)]
        return cls(**fit_tables(rows, tables, restarts=restarts, seed=seed))

    def predict(
        self,
        x: Float[np.ndarray, "row feature"],
        *,
        hs: Float[np.ndarray, " row"],
        mean: Float[np.ndarray, "row line"],
        maximum: Float[np.ndarray, "row line"],
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Mean and largest loads after the change, and the state, at each row of features.

        ``x``: from ``sea_features``.
        ``hs``: wave height where it is lower than in ``x``, else the same [m].
        ``mean``, ``maximum``: expected loads before the change: mean, and largest of three hours
        [N].
        """
        inputs = case_inputs(x)
        after = np.maximum(mean + self.mean.mean(inputs), 0.0)  # a line never pushes
        above = maximum - mean + hs[:, None] * self.maximum.mean(inputs)
        return after, after + np.maximum(above, 0.0), self.state.mean(inputs)
