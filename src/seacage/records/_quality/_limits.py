"""Limits of the quality checks: limits per quantity, and per group of them.

The kinds of test and their flags follow the QARTOD manuals of IOOS for real-time quality
control of in-situ currents, of surface waves and of water levels: gross range (fail, suspect),
climatology, time gap, spike, rate of change, flat line and attenuated signal. The manuals leave
the numbers to the operator; those of ``limits.toml`` are for a moored cage, and a site may give
its own in a file like it.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from seacage.conventions import RecordError, read_packaged_table, read_text
from seacage.records._keys import CURRENT, bin_keys, current_bins
from seacage.records._toml import TomlTable

GROUPS: Mapping[str, tuple[str, ...]] = {
    "current": CURRENT,
    "waves": ("hs_m", "tp_s", "wave_from_deg"),
    "tension": ("tension_kn",),
    "depth": ("depth_m",),
}
"""Quantities that one instrument measures at once; they stand still or jump together."""


def groups_of(names: Iterable[str]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Groups of some keys, those of ``GROUPS`` first, with the keys that are there.

    The current at each depth is a group of its own, ``current at 5 m``.
    """
    there = set(names)
    for group, keys in GROUPS.items():
        if known := tuple(key for key in keys if key in there):
            yield group, known
    for depth in current_bins(there):
        yield f"current at {depth:g} m", bin_keys(depth)


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Gross range of one quantity, in the unit of its key; bounds included."""

    fail: tuple[float, float]  # outside, the value is impossible: FAIL
    suspect: tuple[float, float]  # outside, it is possible but worth a look: SUSPECT


@dataclass(frozen=True, slots=True, kw_only=True)
class Steadiness:
    """How much and how little a group changes between readings that can be used."""

    # A change larger than ``jump + rate * seconds`` is SUSPECT: noise and waves, which lie between
    # any two readings however near, and what the sea can do meanwhile. Of a current it is the
    # length of the vector's change [m/s], of waves the change of hs [m], else of the value. Peak
    # period and wave direction may jump, from swell to wind sea and back.
    jump: float
    rate: float
    gap_s: float  # after a longer silence a value has nothing to be compared with: SUSPECT [s]
    # All values of the group have repeated themselves exactly for as long: SUSPECT, and FAIL where
    # there are also at least 5 of them (3 for SUSPECT) [s]
    flat_suspect_s: float
    flat_fail_s: float
    # A reading that is farther than this from the one before and from the one after, and on the
    # same side of both, as a change is measured: SUSPECT, FAIL. It is only known when the reading
    # after has come, and ``rate`` times the seconds to it is allowed besides.
    spike_suspect: float = math.inf
    spike_fail: float = math.inf
    attenuated_s: float = math.inf  # how long the attenuated signal's window is [s]
    # Over the whole window, and in at least 5 of its 64 parts, the group has stayed within a range
    # smaller than this, of a current in east and in north, of waves in hs: SUSPECT, FAIL
    attenuated_suspect: float = 0.0
    attenuated_fail: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Season:
    """What a quantity is like in some months at one site."""

    months: tuple[int, ...]  # 1 to 12, of the UTC time
    range: Range  # as of the gross range


_TABLES = read_packaged_table("seacage.records", "limits.toml")
_RANGES = {
    key: Range(fail=tuple(one["fail"]), suspect=tuple(one["suspect"]))
    for key, one in _TABLES["ranges"].items()
}
_STEADINESS = {group: Steadiness(**one) for group, one in _TABLES["steadiness"].items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits that a stream is checked against; ``Limits()`` suits a moored cage and its buoy."""

    ranges: Mapping[str, Range] = field(default_factory=_RANGES.copy)  # by door key
    # By group: ``current``, ``waves``, ``tension``, ``depth``
    steadiness: Mapping[str, Steadiness] = field(default_factory=_STEADINESS.copy)
    # By door key: what is usual in the months of the year, where the site knows it; no default
    climatology: Mapping[str, tuple[Season, ...]] = field(
        default_factory=dict[str, tuple[Season, ...]]
    )


DEFAULT_LIMITS = Limits()
"""For a moored cage and its buoy."""


def read_limits(path: Path | str) -> Limits:
    """Read the limits that a site changes; all others are the defaults.

    The file looks like this::

        [ranges.hs_m]
        fail = [0, 15]
        suspect = [0, 9]

        [steadiness.current]
        jump = 0.4
        gap_s = 7200

        [[climatology.hs_m]]
        months = [6, 7, 8]
        suspect = [0, 4]

    Raises RecordError: no TOML, an unknown quantity, group or limit, a value that is no number.
    """
    where = str(path)
    table = TomlTable.parse(read_text(path, refusal=RecordError), where)
    usual, steady = DEFAULT_LIMITS.ranges, DEFAULT_LIMITS.steadiness
    known = {"ranges": usual, "steadiness": steady, "climatology": usual}
    table.check_names(known)
    parts = {name: table.table(name, default={}) for name in known}
    for name, part in parts.items():
        part.check_names(known[name])
    ranges, groups, climate = parts.values()
    spans = {key: ranges.table(key, where=f"{where}, [ranges.{key}]") for key in ranges.values}
    steps = {key: groups.table(key, where=f"{where}, [steadiness.{key}]") for key in groups.values}
    return Limits(
        ranges={**usual, **{key: _range(span, usual[key]) for key, span in spans.items()}},
        steadiness={**steady, **{key: _steadiness(one, key) for key, one in steps.items()}},
        climatology={
            key: tuple(map(_season, climate.tables(key, where=f"{where}, [[climatology.{key}]]")))
            for key in climate.values
        },
    )


def _range(table: TomlTable, usual: Range, *others: str) -> Range:
    """Bounds of a table, which may have other keys; what it leaves out stays as usual."""
    table.check_names(("fail", "suspect", *others))
    return Range(
        fail=_pair(table, "fail") or usual.fail, suspect=_pair(table, "suspect") or usual.suspect
    )


def _pair(table: TomlTable, name: str) -> tuple[float, float] | None:
    if name not in table.values:
        return None
    numbers = table.numbers(name)
    if len(numbers) != 2 or not numbers[0] <= numbers[1]:
        raise RecordError(
            f"{table.where}: {name} = {list(numbers)} is no range. Write [low, high]."
        )
    return numbers[0], numbers[1]


def _steadiness(table: TomlTable, group: str) -> Steadiness:
    table.check_names(Steadiness.__slots__)
    numbers = {name: table.number(name) or 0.0 for name in table.values}
    return replace(DEFAULT_LIMITS.steadiness[group], **numbers)


def _season(table: TomlTable) -> Season:
    months = table.numbers("months")
    if not months or not set(months) <= set(range(1, 13)):
        raise RecordError(
            f"{table.where}: months = {list(months)} are none. Write some of 1 to 12."
        )
    everything = Range(fail=(-math.inf, math.inf), suspect=(-math.inf, math.inf))
    bounds = _range(table, everything, "months")
    return Season(months=tuple(int(month) for month in months), range=bounds)
