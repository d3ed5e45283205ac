"""Values of a TOML table, each of the kind that its reader expects."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import cast

from seacage.conventions import RecordError

Table = Mapping[str, object]


def check_names(table: Table, known: Iterable[str], *, where: str) -> None:
    """Refuse a misspelt key, with the likely one.

    Raises RecordError: at the first key that is not known.
    """
    known = tuple(known)
    for name in table:
        if name not in known:
            close = get_close_matches(name, known, n=1)
            hint = f"Did you mean {close[0]!r}?" if close else f"Known are {', '.join(known)}."
            raise RecordError(f"{where}: the key {name!r} is unknown. {hint}")


def check_filled(table: Table, *, where: str) -> None:
    """Refuse a map that still holds a question of the wizard's.

    Raises RecordError: at the first value that is "?".
    """
    for name, value in table.items():
        if isinstance(value, dict):
            check_filled(cast("Table", value), where=f"{where}, [{name}]")
        elif value == "?":
            raise RecordError(
                f'{where}: {name} is still "?". Fill in what you know of the file; it is never '
                "guessed."
            )


def table_of(table: Table, name: str, *, where: str, default: Table | None = None) -> Table:
    """A table in a table; refused where it is missing and there is no default."""
    value = table.get(name, default)
    if not isinstance(value, dict):
        raise RecordError(f"{where}: the table [{name}] is missing.")
    return cast("Table", value)


def tables_of(table: Table, name: str, *, where: str) -> list[Table]:
    """Return a list of tables; refused where an entry is none."""
    items = _items(table, name, where)
    if not all(isinstance(item, dict) for item in items):
        raise RecordError(f"{where}: {name} is no list of tables. Write [[…{name}]].")
    return [cast("Table", item) for item in items]


def text_of(table: Table, name: str, *, where: str, default: str | None = None) -> str:
    """A text; refused where it is missing and there is no default."""
    value = table.get(name, default)
    if not isinstance(value, str):
        raise RecordError(f'{where}: {name} is missing or no text. Write {name} = "…".')
    return value


def truth_of(table: Table, name: str, *, where: str) -> bool:
    """Whether something holds; it does where it is missing."""
    value = table.get(name, True)
    if not isinstance(value, bool):
        raise RecordError(f"{where}: {name} = {value!r} is neither true nor false.")
    return value


def number_of(table: Table, name: str, *, where: str) -> float | None:
    """A number; None where it is missing."""
    return _number(table[name], name, where) if name in table else None


def numbers_of(table: Table, name: str, *, where: str) -> tuple[float, ...]:
    """A list of numbers; empty where it is missing."""
    return tuple(_number(item, name, where) for item in _items(table, name, where))


def names_of(
    table: Table, name: str, *, where: str, default: tuple[str, ...] | None = None
) -> tuple[str, ...]:
    """Names or numbers of columns, in a list or one; refused where there is no default."""
    value = table.get(name, default)
    items = cast("list[object]", value if isinstance(value, list | tuple) else [value])
    if not all(isinstance(item, str | int) and not isinstance(item, bool) for item in items):
        raise RecordError(
            f'{where}: {name} is missing or names no column. Write {name} = "…", or a list of '
            "names; of numbers where header = false."
        )
    return tuple(str(item) for item in items)


def _number(value: object, name: str, where: str) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise RecordError(f"{where}: {name} = {value!r} is no number.")
    return float(value)


def _items(table: Table, name: str, where: str) -> list[object]:
    value = table.get(name, [])
    if not isinstance(value, list):
        raise RecordError(f"{where}: {name} = {value!r} is no list. Write {name} = [ … ].")
    return cast("list[object]", value)
