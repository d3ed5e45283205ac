"""Timetable of a virtual field: its stretches of time, and those that are simulated."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Self

import numpy as np
from jaxtyping import Bool, Shaped

from seacage.campaigns._buoy_records import span_of
from seacage.conventions import InputError, count_times
from seacage.dynamics import Damage, simulation_lanes
from seacage.records import Record

LONGEST_STEP = 0.002  # of a net that is not refined, as in the low fidelity [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Timetable:
    """Stretches of time in which a virtual field is simulated, many side by side."""

    stretch: float = 3600.0  # length of each [s]
    spin_up: float = 300.0  # simulated before each, and not counted [s]
    # Over which shape and tensions are averaged for the truth [s]; a stretch is a whole number of
    # it
    mean: float = 600.0
    time_step: float = 0.001  # at most [s]
    # Simulate one stretch in so many; the rest are gaps. The first, the last, those that begin with
    # a damage and those in which the shackles live are always simulated.
    one_in: int = 1

    def __post_init__(self) -> None:
        if self.one_in < 1:
            raise InputError(f"Timetable: one stretch in {self.one_in} is none. Give 1 or more.")
        count_times(self.stretch, self.mean, "Timetable: stretch")

    @classmethod
    def over(cls, buoy: Record, *, one_in: int = 1, refined: int = 2) -> Self:
        """Stretches of about an hour that fill the kernel's lanes, in steps of 2 ms / refined.

        A lane that stays empty costs as much as one that is simulated, so the record's time is
        cut into nearly whole vectors of stretches, an even number of them: 36 hours into 31
        stretches of 70 minutes, 48 days into hours.

        ``refined``: of the true net (``NettingTruth``); on longer bars a longer step is as stable.
        """
        plain = cls(one_in=one_in, time_step=LONGEST_STEP / refined)
        lanes, span = 2 * simulation_lanes(), span_of(buoy.time)
        rounds = max(1, round(span / (lanes * plain.stretch)))
        means = math.ceil(span / (rounds * lanes * plain.mean) - 1e-9)
        return replace(plain, stretch=max(means, 1) * plain.mean)

    def readings(self, every: float) -> tuple[int, int]:
        """Readings of a stretch and of a mean.

        Raises InputError: a mean that is no whole number of readings.
        """
        of_mean = count_times(self.mean, every, "Timetable: mean")
        return of_mean * count_times(self.stretch, self.mean, "Timetable: stretch"), of_mean


@dataclass(frozen=True, slots=True, kw_only=True)
class Stretch:
    """A stretch of time, simulated in one go."""

    first: int  # number of its first reading in the record
    # How many count: fewer than were simulated where the record ends or something breaks
    readings: int
    # What is broken when it begins, and what breaks then
    damaged: tuple[Damage, ...] = ()
    breaking: tuple[Damage, ...] = ()

    @property
    def rows(self) -> slice:
        """Its readings in the record."""
        return slice(self.first, self.first + self.readings)


def reading_times(
    buoy: Record, every_s: float | None, *, usual_s: float = 2.0
) -> Shaped[np.ndarray, " t"]:
    """Even times over a buoy's record; a step of None is the usual one.

    Raises InputError: a record or a step that leaves no two.
    """
    span, every_s = span_of(buoy.time), usual_s if every_s is None else every_s
    if not 0.0 < every_s < span:
        raise InputError(
            f"virtual_field: {buoy.stream} spans {span:g} s, which holds no two readings "
            f"every {every_s:g} s. Give a longer record or a shorter step."
        )
    return np.arange(buoy.time[0], buoy.time[-1], np.timedelta64(round(every_s * 1e6), "us"))


def cut(
    readings: int,
    each: int,
    *,
    one_in: int = 1,
    always: Bool[np.ndarray, " reading"],
    breaks: Sequence[tuple[int, Damage]] = (),
) -> tuple[Stretch, ...]:
    """The stretches to simulate, in order of time.

    ``readings``: of the record. ``each``: readings of a stretch. ``one_in``: take one stretch in so
    many, the first and the last in any case. ``always``: readings whose stretches are taken in any
    case. ``breaks``: readings before which something breaks; a new stretch begins there.
    """
    found: list[Stretch] = []
    broken: tuple[Damage, ...] = ()
    begins = sorted({0, *(at for at, _ in breaks)})
    for begin, end in zip(begins, [*begins[1:], readings], strict=True):
        breaking = tuple(damage for at, damage in breaks if at == begin)
        for number, first in enumerate(range(begin, end, each)):
            last = min(first + each, end)
            if number % one_in and last < readings and not always[first:last].any():
                continue
            was, now = (broken + breaking, ()) if number else (broken, breaking)
            found.append(Stretch(first=first, readings=last - first, damaged=was, breaking=now))
        broken += breaking
    return tuple(found)


def side_by_side(stretches: Sequence[Stretch], most: int) -> list[tuple[Stretch, ...]]:
    """Stretches in groups that can be simulated together: of one damage, and not too many."""
    alike = groupby(stretches, key=lambda one: (one.damaged, one.breaking))
    groups = [tuple(group) for _, group in alike]
    return [group[at : at + most] for group in groups for at in range(0, len(group), most)]
