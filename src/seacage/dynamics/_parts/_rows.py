"""Arrays with one row for each of something: the parts of a cage, or cases side by side."""

from dataclasses import dataclass, fields
from typing import Self

import numpy as np


@dataclass(frozen=True, slots=True)
class Rows:
    """Arrays of equal length; a part, or a case, is a row of each."""

    def rows(self, some: np.ndarray) -> Self:
        """Copies of some rows, by their numbers or by a mask."""
        return type(self)(**{f.name: getattr(self, f.name)[some] for f in fields(self)})

    def take(self, some: np.ndarray, other: Self) -> None:
        """Take some rows from elsewhere, in their order there."""
        for f in fields(self):
            getattr(self, f.name)[some] = getattr(other, f.name)

    @classmethod
    def joined(cls, *several: Self) -> Self:
        """All rows of several, one after another."""
        return cls(
            **{f.name: np.concatenate([getattr(s, f.name) for s in several]) for f in fields(cls)}
        )
