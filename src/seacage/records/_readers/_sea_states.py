"""Sea states of a table, one a row."""

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, RecordError
from seacage.ocean import SeaState
from seacage.records._campaign_store import sea_names
from seacage.records._keys import CURRENT
from seacage.records._readers._csv import number_in
from seacage.records._readers._table import PLAIN, Table, read_table

SEA_COLUMNS = {
    "current_speed_m_s": "current_speed",
    "current_to_deg": "current_to",
    "hs_m": "hs",
    "tp_s": "tp",
    "wave_from_deg": "wave_from",
    "current_shear_m_s": "current_shear",
    "shear_to_deg": "shear_to",
}
"""Names of ``SeaState`` by column."""


def sea_columns(seas: Iterable[SeaState]) -> dict[str, str]:
    """``SEA_COLUMNS`` of some seas: those of the shear only where one of them has it."""
    names = sea_names(seas)
    return {key: name for key, name in SEA_COLUMNS.items() if name in names}


_WAVES = ("hs", "tp", "wave_from")


def read_sea_states(path: Path) -> tuple[SeaState, ...]:
    """Sea states of a file that has no other columns.

    Raises RecordError: as ``sea_states``, or another column.
    """
    table = read_table(path, PLAIN)
    if set(table.header) - SEA_COLUMNS.keys():
        raise _other_columns(table)
    return sea_states(table)


def sea_states(table: Table, *, assumed: bool = True) -> tuple[SeaState, ...]:
    """The sea state of each row; an empty tp_s is 5 sqrt(hs_m), any other empty cell 0.

    ``assumed``: whether waves may lack numbers that are taken so; else only where hs_m is 0, or
    where no column is of waves.

    Raises RecordError: a column or a number is missing, or a sea state that cannot be.
    """
    if not set(CURRENT) <= set(table.header):
        raise _other_columns(table)
    columns = {
        name: numbers(table, key, blank=key not in CURRENT)
        for key, name in SEA_COLUMNS.items()
        if key in table.header
    }
    seas: list[SeaState] = []
    for row, line in enumerate(table.lines):
        given = {name: float(column[row]) for name, column in columns.items()}
        waves = [given.get(name, math.nan) for name in _WAVES]
        some = waves[0] != 0.0 and any(map(math.isnan, waves)) and columns.keys() & {*_WAVES}
        if some and not assumed:
            raise RecordError(
                f"{table.path}, line {line}: its waves lack hs_m, tp_s or wave_from_deg. Give what "
                "was simulated, hs_m = 0 without waves, or leave the row out."
            )
        try:
            seas.append(SeaState(**{n: one for n, one in given.items() if not math.isnan(one)}))
        except InputError as error:
            raise RecordError(f"{table.path}, line {line}: {error}") from error
    return tuple(seas)


def numbers(table: Table, column: str, *, blank: bool = False) -> Float[np.ndarray, " row"]:
    """A column of finite numbers, NaN in empty cells where they may be ``blank``.

    Raises RecordError: at the first cell that is none.
    """
    found = np.empty(len(table.rows))
    for row, cell in enumerate(table.column(column)):
        number = number_in(cell, ".")
        found[row] = math.nan if number is None else number
        if not (math.isfinite(found[row]) or (blank and not cell.strip())):
            raise RecordError(
                f"{table.path}, line {table.lines[row]}: {column} = {cell.strip()!r} is no finite "
                "number. Give one, or leave the row out."
            )
    return found


def _other_columns(table: Table) -> RecordError:
    return RecordError(
        f"{table.path}: its columns are {', '.join(table.header)}. A sea state has "
        f"{', '.join(SEA_COLUMNS)}, at least {' and '.join(CURRENT)}: currents go to, waves come "
        "from a direction, clockwise from north."
    )
