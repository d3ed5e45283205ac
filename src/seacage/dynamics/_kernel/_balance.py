"""Settings and state of Newton's method for equilibria."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import Rows


@dataclass(frozen=True, slots=True, kw_only=True)
class Balance:
    """Settings of Newton's method for equilibria.

    ``nearer`` in ``benchmarks/_newton.py`` defines the iteration, and ``_newton.c`` does it.
    """

    free: Bool[np.ndarray, " node"]  # nodes that may move
    tolerance: float  # largest force left on a node of a case that is done [N]
    reach: float  # the farthest that a node goes along an axis in one iteration [m]
    least_barrier: float  # at which the barrier stops falling [N2]
    # Between which the shift stays [N/m]
    least_shift: float
    most_shift: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Balancing(Rows):
    """Cases on their way to balance. A copy can go on later, beside other cases."""

    position: Float[np.ndarray, "case node 3"]  # of the nodes [m]
    # That each bar is taken to bear; above zero in those that go slack [N]
    tension: Float[np.ndarray, "case bar"]
    # Product of a slack bar's tension and the force that its slack is worth [N2]
    barrier: Float[np.ndarray, " case"]
    shift: Float[np.ndarray, " case"]  # added to the tangent's diagonal [N/m]
    # Largest step of the last iteration along an axis, before it was shortened [m]
    moved: Float[np.ndarray, " case"]
    # Of the tangent's determinant, of a case that is done where it ended [-]
    sign: Float[np.ndarray, " case"]
    iterations: Float[np.ndarray, " case"]  # done so far
    residual: Float[np.ndarray, " case"]  # largest force left on a free node [N]

    @classmethod
    def begun(
        cls,
        position: Float[np.ndarray, "case node 3"],
        tension: Float[np.ndarray, "case bar"],
        *,
        barrier: float,
        shift: float,
    ) -> "Balancing":
        """Cases in a first shape."""
        every = np.ones(len(position))
        return cls(
            position=position,
            tension=tension,
            barrier=barrier * every,
            shift=shift * every,
            moved=1e11 * every,
            sign=every.copy(),
            iterations=0.0 * every,
            residual=1e11 * every,
        )
