"""The tables of the store, in the words of either database."""

import re
from collections.abc import Iterable, Mapping
from importlib.resources import files

from seacage.service._store._database._checksum import CHECKED, UNVERIFIED
from seacage.service._store._database._rows import DAY_US

_FIRST = "INSERT INTO tally SELECT cage, '{kind}', {stream}, {day}, count(*) FROM {kind} GROUP BY "
_KINDS = ("sample", "aggregate", "journal")


def tables(words: Mapping[str, str]) -> list[str]:
    """Statements that make the tables where there are none, in a database's words."""
    text = files("seacage.service._store._database").joinpath("schema.sql").read_text("utf-8")
    statements = re.sub("^--.*\n", "", text, flags=re.MULTILINE).format_map(words).split(";")
    return [statement.strip() for statement in statements[:-1]]


def upgrade(words: Mapping[str, str], without: Iterable[str]) -> list[str]:
    """Statements that bring tables of 0.1.0 up to date.

    ``words``: the database's. ``without``: tables that there are without a checksum, in any order.
    """
    old = CHECKED.keys() & set(without)
    if not old:
        return []
    column = f"crc {words['integer']} DEFAULT {UNVERIFIED}"
    day = f"t - ((t % {DAY_US}) + {DAY_US}) % {DAY_US}"
    return [f"ALTER TABLE {name} ADD COLUMN {column}" for name in sorted(old)] + [
        _FIRST.format(kind=kind, day=day, stream="''" if kind == "journal" else "stream")
        + f"1, 3, {day}"
        for kind in _KINDS
    ]
