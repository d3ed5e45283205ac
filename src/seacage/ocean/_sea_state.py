"""One sea state: a current, its shear, and long-crested waves."""

import math
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from seacage.conventions import GRAVITY, InputError, fold_degrees, towards

MAX_CURRENT_SPEED = 3.0
"""Above any current a net cage is moored in; a larger one is a unit mistake [m/s]."""


def steepness_limit(tp: float) -> float:
    """Largest 2 pi Hs / (g Tp^2) that an irregular sea of this peak period sustains.

    Source: DNV-RP-C205 (2010), steepness criteria: 1/15 for Tp <= 8 s, 1/25 for Tp >= 15 s, linear
    between.
    """
    return float(np.interp(tp, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0]))


@dataclass(frozen=True, slots=True, kw_only=True)
class SeaState:
    """Current and irregular waves, validated.

    Raises InputError: a negative, infinite or missing number, a direction outside [0, 360], or a
    sea steeper than ``steepness_limit``.
    """

    current_speed: float  # mean over depth [m/s], at most ``MAX_CURRENT_SPEED``
    current_to: float  # where the current goes, clockwise from true north [deg]
    hs: float = 0.0  # significant wave height [m]; 0 means no waves, and ``tp`` is then ignored
    # Peak period [s]; None means 5 sqrt(hs), the steepest sea the default spectrum takes
    tp: float | None = None
    wave_from: float = 0.0  # where the waves come from, clockwise from true north [deg]
    # Length of the current's shear over depth, as ``over_depth`` takes it [m/s], and where it
    # points, clockwise from true north [deg]; a uniform current by default. Left out of the text,
    # which the hash of a campaign is of
    current_shear: float = field(default=0.0, repr=False)
    shear_to: float = field(default=0.0, repr=False)

    def __post_init__(self) -> None:
        speed = _number("current_speed", self.current_speed, "m/s")
        if speed > MAX_CURRENT_SPEED:
            raise InputError(
                f"SeaState: current_speed = {speed:g} m/s is above {MAX_CURRENT_SPEED:g} m/s. "
                "Check that it is in m/s, not in cm/s or knots."
            )
        shear = _number("current_shear", self.current_shear, "m/s")
        hs = _number("hs", self.hs, "m")
        tp = 5.0 * math.sqrt(hs) if self.tp is None else _number("tp", self.tp, "s")
        if hs > 0.0:
            _check_steepness(hs, tp)
        numbers = {"current_speed": speed, "hs": hs, "tp": tp if hs > 0.0 else 0.0}
        for name, value in {**numbers, "current_shear": shear}.items():
            object.__setattr__(self, name, value)
        if shear == 0.0:
            object.__setattr__(self, "shear_to", 0.0)
        for name in ("current_to", "wave_from", "shear_to"):
            degrees = fold_degrees(getattr(self, name), what=f"SeaState: {name}")
            object.__setattr__(self, name, degrees)

    @property
    def current_velocity(self) -> Float[np.ndarray, "2"]:
        """Velocity of the current, (east, north) [m/s]."""
        return towards(np.array(self.current_speed), np.array(self.current_to))

    @property
    def shear_velocity(self) -> Float[np.ndarray, "2"]:
        """Shear of the current over depth, (east, north) [m/s]."""
        return towards(np.array(self.current_shear), np.array(self.shear_to))

    @property
    def peak_period(self) -> float:
        """``tp``, filled in where it was left out [s]; 0 without waves."""
        assert self.tp is not None
        return self.tp

    @property
    def wave_direction(self) -> Float[np.ndarray, "2"]:
        """Unit vector the waves travel along, (east, north)."""
        return -towards(np.array(1.0), np.array(self.wave_from))


def _number(name: str, value: float, unit: str) -> float:
    if not math.isfinite(value) or value < 0.0:
        raise InputError(
            f"SeaState: {name} = {value:g} {unit} is not a finite number of at least 0. "
            "Leave the sea state out where there is no valid measurement."
        )
    return float(value)


def _check_steepness(hs: float, tp: float) -> None:
    square = tp * tp  # of a tiny period 0, of a huge one inf
    steepness = math.inf if square == 0.0 else 2.0 * math.pi * hs / (GRAVITY * square)
    limit = steepness_limit(tp)
    if steepness > limit:
        raise InputError(
            f"SeaState: hs = {hs:g} m with tp = {tp:g} s has steepness {steepness:.2g}; a sea "
            f"steeper than {limit:.3f} cannot stand (DNV-RP-C205, steepness criteria). "
            "Check that tp is a period in s, not a frequency in Hz."
        )
