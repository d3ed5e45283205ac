"""What the quality checks compare with: limits per quantity, and per group of them.

The kinds of test and their flags follow the QARTOD manuals of IOOS for real-time quality
control of in-situ currents, of surface waves and of water levels: gross range (fail, suspect),
time gap, rate of change and flat line. The manuals leave the numbers to the operator; these are
for a moored cage, and a site may give its own.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from seacage.ocean import MAX_CURRENT_SPEED

GROUPS: Mapping[str, tuple[str, ...]] = {
    "current": ("current_speed_m_s", "current_to_deg"),
    "waves": ("hs_m", "tp_s", "wave_from_deg"),
    "tension": ("tension_kn",),
    "depth": ("depth_m",),
}
"""Quantities that one instrument measures at once; they stand still or jump together."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Gross range of one quantity, in the unit of its key; bounds included.

    Parameters
    ----------
    fail
        Outside, the value is impossible: FAIL.
    suspect
        Outside, it is possible but worth a look: SUSPECT.
    """

    fail: tuple[float, float]
    suspect: tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Steadiness:
    """How much and how little a group changes between readings that can be used.

    Parameters
    ----------
    jump, rate
        A change larger than ``jump + rate * seconds`` is SUSPECT: noise, and what the sea can
        do. Of a current it is the length of the vector's change [m/s], of waves the change of
        hs [m], else of the value. Peak period and wave direction may jump, from swell to wind
        sea and back.
    gap_s
        After a longer silence a value has nothing to be compared with: SUSPECT [s].
    flat_suspect_s, flat_fail_s
        All values of the group have repeated themselves exactly for as long: SUSPECT, and
        FAIL where there are also at least 5 of them (3 for SUSPECT) [s].
    """

    jump: float
    rate: float
    gap_s: float
    flat_suspect_s: float
    flat_fail_s: float


def _ranges() -> dict[str, Range]:
    compass = Range(fail=(0.0, 360.0), suspect=(0.0, 360.0))
    return {
        "current_speed_m_s": Range(fail=(0.0, MAX_CURRENT_SPEED), suspect=(0.0, 2.0)),
        "current_to_deg": compass,
        "hs_m": Range(fail=(0.0, 20.0), suspect=(0.0, 12.0)),
        "tp_s": Range(fail=(0.0, 30.0), suspect=(0.0, 25.0)),
        "wave_from_deg": compass,
        # A slack bridle reads a little below zero by its shackle's bias; a deep sensor above
        # water by a swing of the air pressure.
        "tension_kn": Range(fail=(-5.0, 1000.0), suspect=(-1.0, 400.0)),
        "depth_m": Range(fail=(-2.0, 200.0), suspect=(-0.5, 100.0)),
    }


def _steadiness() -> dict[str, Steadiness]:
    hour = 3600.0
    return {
        "current": Steadiness(
            jump=0.3, rate=3e-4, gap_s=3 * hour, flat_suspect_s=hour, flat_fail_s=3 * hour
        ),
        "waves": Steadiness(
            jump=1.0, rate=6e-4, gap_s=3 * hour, flat_suspect_s=12 * hour, flat_fail_s=36 * hour
        ),
        "tension": Steadiness(
            jump=15.0, rate=0.02, gap_s=hour, flat_suspect_s=0.5 * hour, flat_fail_s=2 * hour
        ),
        "depth": Steadiness(
            jump=1.5, rate=0.01, gap_s=hour, flat_suspect_s=0.5 * hour, flat_fail_s=2 * hour
        ),
    }


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a stream is checked against; ``Limits()`` suits a moored cage and its buoy.

    Parameters
    ----------
    ranges
        By door key.
    steadiness
        By group: ``current``, ``waves``, ``tension``, ``depth``.
    """

    ranges: Mapping[str, Range] = field(default_factory=_ranges)
    steadiness: Mapping[str, Steadiness] = field(default_factory=_steadiness)


DEFAULT_LIMITS = Limits()
"""For a moored cage and its buoy."""
