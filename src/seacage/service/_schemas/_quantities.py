"""Numbers of a state that other systems read, each with its name, its place and its unit."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce
from typing import NamedTuple

from seacage.conventions import read_packaged_table
from seacage.service._schemas._state import State


class Unit(NamedTuple):
    """A unit: its symbol, its name in Prometheus and the factor to it, and UNECE's code for it."""

    symbol: str
    metric: str
    factor: float
    unece: str


SHARE = Unit("1", "ratio", 1.0, "C62")
# By the end of a name, the longer before those that end alike
_UNITS = {
    "_fraction": SHARE,
    "_m_s": Unit("m/s", "meters_per_second", 1.0, "MTS"),
    "_deg": Unit("°", "degrees", 1.0, "DD"),
    "_kn": Unit("kN", "newtons", 1e3, "B47"),
    "_m": Unit("m", "meters", 1.0, "MTR"),
    "_s": Unit("s", "seconds", 1.0, "SEC"),
}
# The list of a state that has a part, and its entries' unit where only some are meant
_LISTS: dict[str, tuple[str, str | None]] = {
    "bridle": ("bridles", None),
    "line": ("lines", None),
    "shackle": ("sensors", "kN"),
    "depth": ("sensors", "m"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """A number of a state; ``quantities.toml`` says what its fields mean."""

    part: str
    name: str
    at: str
    about: str
    flag: bool = False
    title: str = ""

    @property
    def entries(self) -> str | None:
        """The list of the state whose entries have the number; None where it is the state's own."""
        return _LISTS[self.part][0] if self.part in _LISTS else None

    @property
    def unit(self) -> Unit | None:
        """Its unit; None of a flag."""
        ends = (unit for end, unit in _UNITS.items() if self.name.endswith(end))
        return None if self.flag else next(ends, SHARE)

    @property
    def metric(self) -> str:
        """Its name in Prometheus."""
        stem = self.name if self.part == "cage" else f"{self.part}_{self.name}"
        end = next((end for end in _UNITS if stem.endswith(end)), "")
        return f"seacage_{stem.removesuffix(end)}{f'_{self.unit.metric}' if self.unit else ''}"

    def read(self, state: State) -> Iterator[tuple[str, float | None]]:
        """Name of each entry of the part, empty where there is but one, and its number."""
        if self.entries is None:
            yield "", _follow(state, self.at)
            return
        unit = _LISTS[self.part][1]
        for entry in getattr(state, self.entries):
            if unit is None or entry.unit == unit:
                yield entry.name, _follow(entry, self.at)


def _follow(thing: object, path: str) -> float | None:
    value = reduce(lambda one, key: getattr(one, key, None), path.split("."), thing)
    assert value is None or isinstance(value, float | int)
    return value


QUANTITIES = tuple(
    Quantity(part=part, name=name, **fields)
    for part, table in read_packaged_table("seacage.service._schemas", "quantities.toml").items()
    for name, fields in table.items()
)
