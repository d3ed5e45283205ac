"""Sea states as features, where directions are vectors without a seam at north; their domain."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError
from seacage.surrogates._prediction import check_inputs

PerRow = Float[np.ndarray, " row"]
Row2 = Float[np.ndarray, "row 2"]
RowFeature = Float[np.ndarray, "row feature"]
# Share by which a length may differ from that of its vector: features may come rounded
ROUNDED = 1e-3
MARGIN = 0.01  # of each feature's range: a sampled campaign never quite reaches its own limits


def current_features(current_velocity: Row2) -> Float[np.ndarray, "row 3"]:
    """Features (U, U cos phi, U sin phi) of currents, phi from east.

    The vector alone would do, but loads grow with the speed, and the speed has a kink at slack
    water that a smooth function of the vector cannot follow.

    ``current_velocity``: towards (east, north) [m/s].

    Returns speed, east and north component [m/s].
    """
    speed = np.hypot(current_velocity[:, 0], current_velocity[:, 1])
    return np.column_stack([speed, current_velocity])


def wave_features(hs: PerRow, wave_direction: Row2, *, tp: PerRow | None = None) -> RowFeature:
    """Features (Hs, Hs cos beta, Hs sin beta) of waves, beta from east.

    Where the peak period is known too they are (W, W cos beta, W sin beta, Hs), W = pi Hs / Tp
    being the speed of the water at the surface of regular waves of that height and period: what
    the waves add to the current.

    ``hs``: significant wave height [m].
    ``wave_direction``: unit vector that the waves travel along, (east, north) [-].
    ``tp``: peak period [s]; of no meaning where there are no waves.

    Returns height, east and north component [m]; or speed, east and north component [m/s], and
    height [m].
    """
    if tp is None:
        return np.column_stack([hs, hs[:, None] * wave_direction])
    speed = np.pi * hs / np.where(hs > 0.0, tp, 1.0)
    return np.column_stack([speed, speed[:, None] * wave_direction, hs])


def metocean_features(
    current_velocity: Row2,
    *,
    hs: PerRow | None = None,
    wave_direction: Row2 | None = None,
    tp: PerRow | None = None,
) -> RowFeature:
    """All that a buoy measures as features: ``current_features``, then ``wave_features``.

    ``ShapeGP`` can turn these, so it may fold by a symmetry.

    ``current_velocity``, ``hs``, ``wave_direction``, ``tp``: as there; without ``hs`` the current
    alone.

    Returns 3 columns of the current alone, 6 with waves, 7 with their period.
    """
    current = current_features(current_velocity)
    if hs is None and wave_direction is None and tp is None:
        return current
    if hs is None or wave_direction is None:
        raise InputError(
            "metocean_features: waves need both hs and wave_direction. Give both, or neither."
        )
    return np.hstack([current, wave_features(hs, wave_direction, tp=tp)])


def sea_features(
    current_velocity: Row2, *, hs: PerRow, tp: PerRow, wave_direction: Row2
) -> Float[np.ndarray, "row 7"]:
    """Features of a sea whose loads vary with its waves.

    ``current_velocity``: towards (east, north) [m/s].
    ``hs``, ``tp``: significant wave height [m], peak period [s].
    ``wave_direction``: unit vector that the waves travel along, (east, north) [-].

    Returns ``current_features``, Hs, east and north component of the direction, log(Tp / 1 s). A
    symmetry turns both vectors.
    """
    current = current_features(current_velocity)
    return np.column_stack([current, hs, wave_direction, np.log(np.maximum(tp, 1e-3))])


def vector_columns(width: int) -> tuple[slice, ...]:
    """Where ``metocean_features`` of this width holds vectors."""
    return (slice(1, 3), slice(4, 6))[: 1 + (width > 3)]


def check_turnable(x: RowFeature, *, what: str) -> None:
    """Refuse features that cannot be turned, for their vectors are not where they should be."""
    if x.shape[1] not in (3, 6, 7):
        raise InputError(
            f"{what}: x has {x.shape[1]} features per row; a symmetry turns the 3, 6 or "
            "7 of metocean_features. Build x with it."
        )
    for at in vector_columns(x.shape[1]):
        length, vector = x[:, at.start - 1], x[:, at]
        wrong = np.abs(np.hypot(*vector.T) - length) > ROUNDED * np.abs(length) + 1e-9
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"{what}: in row {row} feature {at.start - 1} = {length[row]:g} is not the length "
                f"of the vector ({vector[row, 0]:g}, {vector[row, 1]:g}) after it. Directions in "
                "degrees cannot be turned: build x with metocean_features."
            )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Domain:
    """Range of each feature in the training.

    A box: it knows nothing of gaps inside it, and of a current its speed limits the corners.
    """

    # Smallest and largest value of each feature
    lower: Float[np.ndarray, " feature"]
    upper: Float[np.ndarray, " feature"]

    @classmethod
    def of(cls, x: Float[np.ndarray, "n feature"]) -> Self:
        """Learn from the training inputs."""
        x = check_inputs(x, what="Domain.of")
        return cls(lower=x.min(axis=0), upper=x.max(axis=0))

    def contains(self, x: Float[np.ndarray, "row feature"]) -> Bool[np.ndarray, " row"]:
        """Whether each row lies within every range, give or take 1 % of it."""
        x = check_inputs(x, what="Domain.contains", width=len(self.lower))
        margin = MARGIN * (self.upper - self.lower)
        return np.all((x >= self.lower - margin) & (x <= self.upper + margin), axis=1)
