"""Limits of the quality checks: limits per quantity, and per group of them.

The kinds of test and their flags follow the QARTOD manuals of IOOS for real-time quality
control of in-situ currents, of surface waves and of water levels: gross range (fail, suspect),
climatology, time gap, spike, rate of change, flat line and attenuated signal. The manuals leave
the numbers to the operator; these are for a moored cage, and a site may give its own.
"""

import math
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
        A change larger than ``jump + rate * seconds`` is SUSPECT: noise and waves, which lie
        between any two readings however near, and what the sea can do meanwhile. Of a current
        it is the length of the vector's change [m/s], of waves the change of hs [m], else of
        the value. Peak period and wave direction may jump, from swell to wind sea and back.
    gap_s
        After a longer silence a value has nothing to be compared with: SUSPECT [s].
    flat_suspect_s, flat_fail_s
        All values of the group have repeated themselves exactly for as long: SUSPECT, and
        FAIL where there are also at least 5 of them (3 for SUSPECT) [s].
    spike_suspect, spike_fail
        A reading that is farther than this from the one before and from the one after, and on
        the same side of both, as a change is measured: SUSPECT, FAIL. It is only known when
        the reading after has come, and ``rate`` times the seconds to it is allowed besides.
    attenuated_s
        How long the attenuated signal's window is [s].
    attenuated_suspect, attenuated_fail
        Over the whole window, and in at least 5 of its 64 parts, the group has stayed within
        a range smaller than this, of a current in east and in north, of waves in hs: SUSPECT,
        FAIL.
    """

    jump: float
    rate: float
    gap_s: float
    flat_suspect_s: float
    flat_fail_s: float
    spike_suspect: float = math.inf
    spike_fail: float = math.inf
    attenuated_s: float = math.inf
    attenuated_suspect: float = 0.0
    attenuated_fail: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Season:
    """What a quantity is like in some months at one site.

    Parameters
    ----------
    months
        1 to 12, of the UTC time.
    range
        As of the gross range.
    """

    months: tuple[int, ...]
    range: Range


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
            jump=0.3,
            rate=3e-4,
            gap_s=3 * hour,
            flat_suspect_s=hour,
            flat_fail_s=3 * hour,
            spike_suspect=0.8,
            spike_fail=1.5,
            attenuated_s=12 * hour,
            attenuated_suspect=0.02,
            attenuated_fail=0.005,
        ),
        "waves": Steadiness(
            jump=1.0,
            rate=6e-4,
            gap_s=3 * hour,
            flat_suspect_s=12 * hour,
            flat_fail_s=36 * hour,
            spike_suspect=2.0,
            spike_fail=5.0,
            attenuated_s=72 * hour,
            attenuated_suspect=0.05,
        ),
        "tension": Steadiness(
            # At Hs 3 m readings of a simulated bridle 2 s apart differ by up to 42 kN: a wrong one
            # that is nearer hides among the waves' loads.
            jump=45.0,
            rate=0.02,
            gap_s=hour,
            flat_suspect_s=0.5 * hour,
            flat_fail_s=2 * hour,
            # Waves load and slacken a bridle between two readings, so only the absurd fails.
            spike_suspect=60.0,
            spike_fail=200.0,
            attenuated_s=2 * hour,
            attenuated_suspect=0.01,
            attenuated_fail=0.001,
        ),
        "depth": Steadiness(
            # The net follows the surface: at Hs 3 m simulated sensors change by up to 1.7 m, and
            # stand out by up to 1.3 m.
            jump=2.0,
            rate=0.01,
            gap_s=hour,
            flat_suspect_s=0.5 * hour,
            flat_fail_s=2 * hour,
            spike_suspect=2.0,
            spike_fail=3.0,
            attenuated_s=2 * hour,
            attenuated_suspect=0.002,
            attenuated_fail=0.0005,
        ),
    }


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits that a stream is checked against; ``Limits()`` suits a moored cage and its buoy.

    Parameters
    ----------
    ranges
        By door key.
    steadiness
        By group: ``current``, ``waves``, ``tension``, ``depth``.
    climatology
        By door key: what is usual in the months of the year, where the site knows it; no
        default.
    """

    ranges: Mapping[str, Range] = field(default_factory=_ranges)
    steadiness: Mapping[str, Steadiness] = field(default_factory=_steadiness)
    climatology: Mapping[str, tuple[Season, ...]] = field(
        default_factory=dict[str, tuple[Season, ...]]
    )


DEFAULT_LIMITS = Limits()
"""For a moored cage and its buoy."""
