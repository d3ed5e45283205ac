"""Arrays with one row for each of something: parts of a cage, cases, points, times."""

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Arrays of equal length; fields that are neither arrays nor rows hold for all of them."""

    def rows(self, some: np.ndarray | slice) -> Self:
        """Some rows, by their numbers, by a mask or from one to another."""
        return replace(self, **{name: _some(one, some) for name, one in _columns(self).items()})

    def take(self, some: np.ndarray, other: Self) -> None:
        """Take some rows from elsewhere, in their order there."""
        for name, one in _columns(self).items():
            one[some] = getattr(other, name)

    @classmethod
    def none(cls) -> Self:
        """No rows, of the shapes and the kinds that the fields declare, all arrays."""
        return cls(**{one.name: _empty(one.type) for one in fields(cls)})

    @classmethod
    def joined(cls, *several: Self) -> Self:
        """All rows of several, one after another."""
        names = _columns(several[0])
        columns = {name: _join([getattr(one, name) for one in several]) for name in names}
        return replace(several[0], **columns)


def _columns(rows: Rows) -> dict[str, Any]:
    found = {one.name: getattr(rows, one.name) for one in fields(rows)}
    return {name: one for name, one in found.items() if isinstance(one, np.ndarray | Rows)}


def _empty(declared: Any) -> np.ndarray:
    kind = next(name for name in ("bool", "int64", "float64") if name in declared.dtypes)
    return np.zeros((0, *map(int, declared.dim_str.split()[1:])), dtype=kind)


def _some(column: Any, some: np.ndarray | slice) -> Any:
    return column.rows(some) if isinstance(column, Rows) else column[some]


def _join(columns: list[Any]) -> Any:
    first = columns[0]
    return first.joined(*columns) if isinstance(first, Rows) else np.concatenate(columns)
