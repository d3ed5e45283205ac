"""Compass degrees at the doors, vectors inside: x east, y north."""

import numpy as np
from jaxtyping import Float

from seacage.conventions._errors import InputError


def fold_degrees(degrees: float, *, what: str) -> float:
    """Fold a compass direction into [0, 360): only 360 itself moves.

    ``degrees``: clockwise from true north [deg]. ``what``: the name of the quantity, for the
    error's sentence.

    Raises InputError: below 0, above 360 or not a number.
    """
    if not 0.0 <= degrees <= 360.0:
        raise InputError(
            f"{what} = {degrees:g} deg is outside [0, 360]. "
            "Give degrees clockwise from true north; fold turns before the door."
        )
    return 0.0 if degrees == 360.0 else float(degrees)


def towards(
    speed: Float[np.ndarray, "*n"], degrees_to: Float[np.ndarray, "*n"]
) -> Float[np.ndarray, "*n 2"]:
    """Horizontal vectors (east, north) of flows that go towards a direction.

    ``speed``: length of the vector [any unit, kept].
    ``degrees_to``: clockwise from true north, where the flow goes [deg].
    """
    angle = np.deg2rad(degrees_to)
    return np.stack([speed * np.sin(angle), speed * np.cos(angle)], axis=-1)


def compass(vector: Float[np.ndarray, "*n 2"]) -> Float[np.ndarray, "*n"]:
    """Compass direction in [0, 360) that (east, north) vectors point towards [deg]."""
    degrees = np.rad2deg(np.arctan2(vector[..., 0], vector[..., 1])) % 360.0
    return np.where(degrees >= 360.0, 0.0, degrees)
