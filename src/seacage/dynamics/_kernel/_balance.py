"""Settings and state of Newton's method for equilibria."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import Rows


@dataclass(frozen=True, slots=True, kw_only=True)
class Balance:
    """Settings of Newton's method for equilibria; ``nearer`` defines the iteration.

    Attributes
    ----------
    free
        Nodes that may move.
    tolerance
        Largest force left on a node of a case that is done [N].
    reach
        The farthest that a node goes along an axis in one iteration [m].
    least_barrier
        At which the barrier stops falling [N2].
    least_shift, most_shift
        Between which the shift stays [N/m].
    """

    free: Bool[np.ndarray, " node"]
    tolerance: float
    reach: float
    least_barrier: float
    least_shift: float
    most_shift: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Balancing(Rows):
    """Cases on their way to balance. A copy can go on later, beside other cases.

    Attributes
    ----------
    position
        Of the nodes [m].
    tension
        That each bar is taken to bear; above zero in those that go slack [N].
    barrier
        Product of a slack bar's tension and the force that its slack is worth [N2].
    shift
        Added to the tangent's diagonal [N/m].
    moved
        Largest step of the last iteration along an axis, before it was shortened [m].
    sign
        Of the tangent's determinant, of a case that is done where it ended [-].
    iterations
        Done so far.
    residual
        Largest force left on a free node [N].
    """

    position: Float[np.ndarray, "case node 3"]
    tension: Float[np.ndarray, "case bar"]
    barrier: Float[np.ndarray, " case"]
    shift: Float[np.ndarray, " case"]
    moved: Float[np.ndarray, " case"]
    sign: Float[np.ndarray, " case"]
    iterations: Float[np.ndarray, " case"]
    residual: Float[np.ndarray, " case"]

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
