"""A site's own limits, from TOML."""

import math
from dataclasses import replace
from pathlib import Path

from seacage.conventions import RecordError, read_text
from seacage.records._quality._limits import DEFAULT_LIMITS, Limits, Range, Season, Steadiness
from seacage.records._toml import TomlTable


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
