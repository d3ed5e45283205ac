"""Laws of the netting by name: ours, and the screen laws of other packages."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, call_extension, load_extension

LAWS = ("aarsnes", "loland", "kristiansen-faltinsen")
"""The screen laws that come with seacage."""
MOVING_LAWS = (*LAWS, "morison")
"""Laws of a net that moves: "morison" loads it twine by twine."""

PerPanel = Float[np.ndarray, "*case panel"]


@dataclass(frozen=True, slots=True, kw_only=True)
class ScreenLaw:
    """Screen law of one's own, for ``settle`` and ``simulate`` or for an entry point.

    C_D = s (1 − cosθ) + C_D0 ((1 − h) cosθ + h cos3θ), at least 0, and
    C_L = C_L0 sin2θ (1 + e cos2θ), θ being the angle between a panel's normal and the flow.
    """

    title: str  # its authors and the year, for messages
    # C_D0, at least 0, and C_L0 of solidities [-]: arrays of the same shape
    coefficients: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    skin_friction: float = 0.0  # s, the C_D of a panel along the flow [-]
    # h and e, the shares of drag and lift that vary with cos3θ and cos2θ [-]
    third: float = 0.0
    second: float = 0.0

    def facing(self, solidity: PerPanel) -> tuple[PerPanel, PerPanel]:
        """C_D0 and C_L0 of each panel [-]. Raises InputError: the law gives no sound numbers."""
        drag, lift = call_extension(
            f"screen law {self.title!r}", self.coefficients, solidity.copy()
        )
        least = min(float(np.min(drag)), self.skin_friction)
        if not (np.isfinite(drag + lift + self.third + self.second).all() and least >= 0.0):
            raise InputError(
                f"Screen law {self.title!r}: solidities of {solidity.min():g} to "
                f"{solidity.max():g} give a drag down to {least:g} and a lift down to "
                f"{np.min(lift):g}; they must be finite and drag at least 0. Use another law."
            )
        return drag, lift


Law = str | ScreenLaw
"""Law of the netting: the name of one of ours or of an installed one, or a ``ScreenLaw``."""


def own_law(law: Law, *, ours: tuple[str, ...] = MOVING_LAWS) -> ScreenLaw | None:
    """A law that is not ours, loaded by its name; None for one of ours.

    Raises InputError: a name that is neither ours nor installed, or no law behind it.
    """
    if isinstance(law, ScreenLaw):
        return law
    return None if law in ours else load_extension("screen_laws", law, ScreenLaw, ours).value


def law_label(law: str) -> str:
    """A law's name for a record, with its package and version where it is not ours."""
    if own_law(law) is None:
        return law
    return f"{law} ({load_extension('screen_laws', law, ScreenLaw, MOVING_LAWS).source})"
