"""Numbers of a state that other systems read, each with its name, its place and its unit."""

from collections.abc import Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import NamedTuple

from seacage.conventions import read_packaged_table
from seacage.service._schemas._state import State

_TABLE = read_packaged_table("seacage.service._schemas", "quantities.toml")


class Unit(NamedTuple):
    """A unit, and what other systems call it; ``quantities.toml`` has them."""

    symbol: str
    metric: str
    factor: float
    unece: str
    device_class: str


SHARE = Unit("1", "ratio", 1.0, "C62", "")
_UNITS = {end: Unit(*fields) for end, fields in _TABLE["units"].items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """A number of a state; ``quantities.toml`` says what its fields mean."""

    part: str
    name: str
    at: str
    about: str
    entries: str = ""
    only: str = ""
    flag: bool = False
    title: str = ""

    @property
    def unit(self) -> Unit | None:
        """Its unit; None of a flag."""
        return None if self.flag else _UNITS.get(self._end, SHARE)

    @property
    def metric(self) -> str:
        """Its name in Prometheus."""
        words = [] if self.part == "cage" else [self.part]
        unit = [self.unit.metric] if self.unit else []
        return "_".join(["seacage", *words, self.name.removesuffix(self._end), *unit])

    def read(self, state: State) -> Iterator[tuple[str, float | None]]:
        """Name of each entry of the part, empty where there is but one, and its number."""
        if not self.entries:
            known = not self.at.startswith("water.") or state.water
            yield "", attrgetter(self.at)(state) if known else None
            return
        for entry in getattr(state, self.entries):
            if not self.only or entry.unit == self.only:
                yield entry.name, attrgetter(self.at)(entry)

    @property
    def _end(self) -> str:
        return next((end for end in _UNITS if self.name.endswith(end)), "")


QUANTITIES = tuple(
    Quantity(part=part, name=name, **_TABLE["entries"].get(part, {}), **fields)
    for part, named in _TABLE["parts"].items()
    for name, fields in named.items()
)
