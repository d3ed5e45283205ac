"""A site's own limits, from TOML."""

import math
from dataclasses import replace
from pathlib import Path

from seacage.conventions import RecordError, parse_toml, read_text
from seacage.records._quality._limits import DEFAULT_LIMITS, Limits, Range, Season, Steadiness
from seacage.records._toml import Table, check_names, number_of, numbers_of, table_of, tables_of


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
    table = parse_toml(read_text(path, refusal=RecordError), where, refusal=RecordError)
    usual, steady = DEFAULT_LIMITS.ranges, DEFAULT_LIMITS.steadiness
    known = {"ranges": usual, "steadiness": steady, "climatology": usual}
    check_names(table, known, where=where)
    parts = {name: table_of(table, name, where=where, default={}) for name in known}
    for name, part in parts.items():
        check_names(part, known[name], where=f"{where}, [{name}]")
    ranges = {
        key: parse_range(table_of(parts["ranges"], key, where=where), usual[key], where)
        for key in parts["ranges"]
    }
    return Limits(
        ranges={**usual, **ranges},
        steadiness={**steady, **_steadiness(parts["steadiness"], where)},
        climatology=_climatology(parts["climatology"], where),
    )


def parse_range(table: Table, usual: Range, where: str) -> Range:
    """Bounds of a table; those that it leaves out stay the usual ones.

    Raises RecordError: bounds that are not two ascending numbers.
    """
    check_names(table, ("fail", "suspect"), where=where)
    return Range(
        fail=_pair(table, "fail", where) or usual.fail,
        suspect=_pair(table, "suspect", where) or usual.suspect,
    )


def _pair(table: Table, name: str, where: str) -> tuple[float, float] | None:
    if name not in table:
        return None
    numbers = numbers_of(table, name, where=where)
    if len(numbers) != 2 or not numbers[0] <= numbers[1]:
        raise RecordError(f"{where}: {name} = {list(numbers)} is no range. Write [low, high].")
    return numbers[0], numbers[1]


def _steadiness(table: Table, where: str) -> dict[str, Steadiness]:
    changed: dict[str, Steadiness] = {}
    for group in table:
        inside = f"{where}, [steadiness.{group}]"
        given = table_of(table, group, where=where)
        check_names(given, Steadiness.__slots__, where=inside)
        numbers = {name: number_of(given, name, where=inside) or 0.0 for name in given}
        changed[group] = replace(DEFAULT_LIMITS.steadiness[group], **numbers)
    return changed


def _climatology(table: Table, where: str) -> dict[str, tuple[Season, ...]]:
    seasons: dict[str, tuple[Season, ...]] = {}
    for key in table:
        inside = f"{where}, [[climatology.{key}]]"
        seasons[key] = tuple(_season(one, inside) for one in tables_of(table, key, where=inside))
    return seasons


def _season(table: Table, where: str) -> Season:
    months = numbers_of(table, "months", where=where)
    if not months or not set(months) <= set(range(1, 13)):
        raise RecordError(f"{where}: months = {list(months)} are none. Write some of 1 to 12.")
    everything = Range(fail=(-math.inf, math.inf), suspect=(-math.inf, math.inf))
    bounds = {name: value for name, value in table.items() if name != "months"}
    return Season(
        months=tuple(int(month) for month in months), range=parse_range(bounds, everything, where)
    )
