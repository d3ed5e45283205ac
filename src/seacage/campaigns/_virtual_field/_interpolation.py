"""Values in even steps of time, read between them."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Even:
    """Values in even steps from second 0 on, straight between them."""

    step: float  # between rows [s]
    values: Float[np.ndarray, "row value"]  # two rows at least
    first: int = 0  # row of the whole that comes first here
    count: int | None = None  # rows of the whole; None where all are here

    def at(
        self, second: float | Float[np.ndarray, " t"], *, held: bool = True
    ) -> Float[np.ndarray, "*t value"]:
        """Values at a time or some.

        Beyond the whole the end values are held, or go on as straight as the last step if not
        ``held``.

        Raises InputError: a time of the whole that was cut off.
        """
        place = np.asarray(second / self.step - self.first)
        self._check(float(place.min()), float(place.max()))
        row = np.clip(np.floor(place), 0, len(self.values) - 2).astype(np.intp)
        share = (place - row)[..., None]
        if held:
            share = np.clip(share, 0.0, 1.0)
        return (1.0 - share) * self.values[row] + share * self.values[row + 1]

    def between(self, start: float, end: float) -> Self:
        """The rows around the time from one second to another."""
        last = len(self.values)
        low = min(max(math.floor(start / self.step) - self.first, 0), last - 2)
        high = max(min(math.ceil(end / self.step) - self.first + 1, last), low + 2)
        return replace(
            self,
            values=self.values[low:high].copy(),
            first=self.first + low,
            count=self.count or last,
        )

    def _check(self, least: float, most: float) -> None:
        last = len(self.values) - 1
        early = self.first > 0 and least < 0.0
        late = self.count is not None and self.first + last + 1 < self.count and most > last
        if early or late:
            wrong = (least if early else most) + self.first
            raise InputError(
                f"Weather: second {wrong * self.step:g} is not among those kept, "
                f"{self.first * self.step:g} to {(self.first + last) * self.step:g}. "
                "Keep a longer time with `between`."
            )
