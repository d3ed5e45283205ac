"""What the sensors usually read more than the twin says, though nothing is wrong."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.twin._faults._residuals import Block
from seacage.twin._faults._student_t import learned

OFF, DRAG = 0.5, 0.1
"""What is thought before anything is seen: standard deviations of how far a sensor is off, in its
own ones, and of how far the drag that it feels is [-]. Lessons are short and nets grow."""

MEMORY = 5376
"""Blocks in which what was learned is forgotten: sixteen weeks. What comes within days is no
habit."""

RESTLESS, RESTLESS_MEMORY = 0.5, 168
"""Mean square of a sensor's errors that is thought of first, in its own standard deviations; and
the blocks in which it is learned: half a week."""

WILD = 9.0
"""What one block teaches of that at most."""

WARY = 2.0
"""Times that, because errors last from one block to the next; what the twin says is the least."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Expected:
    """A shift of the sensors' readings [N] or [m], and its covariance."""

    shift: Float[np.ndarray, " sensor"]
    spread: Float[np.ndarray, "sensor sensor"]

    def and_also(self, others: Iterable["Expected"]) -> "Expected":
        """Add other shifts that have nothing to do with it."""
        each = [self, *others]
        return Expected(
            shift=np.sum([one.shift for one in each], axis=0),
            spread=np.sum([one.spread for one in each], axis=0),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Usual:
    """What is known of the sensors' habits.

    Parameters
    ----------
    sensors
        Their names; none before the first block.
    size, covariance
        How far each is off, in standard deviations, then how much more drag each feels [-].
    restless
        Mean square of what is left of each one's errors, in standard deviations.
    """

    sensors: tuple[str, ...] = ()
    size: tuple[float, ...] = ()
    covariance: tuple[tuple[float, ...], ...] = ()
    restless: tuple[float, ...] = ()

    def of(self, sensors: tuple[str, ...]) -> Self:
        """Return the same, or what is known of these where it was learned of others."""
        if sensors == self.sensors:
            return self
        size, restless = (0.0,) * (2 * len(sensors)), (RESTLESS,) * len(sensors)
        return replace(self, sensors=sensors, size=size, restless=restless).doubted()

    def doubted(self) -> Self:
        """Return the same with habits to be learned anew, as the cage has changed."""
        return replace(self, covariance=_listed(self._first()))

    def expected(self, block: Block) -> Expected:
        """Say what the sensors would read more in a block, with the errors of it."""
        felt = self._felt(block)
        habits = felt @ np.array(self.covariance) @ felt.T
        own = block.own**2 * self._wary()
        return Expected(
            shift=felt @ np.array(self.size), spread=habits + np.diag(own) + block.water
        )

    def learned(self, block: Block, known: Iterable[Expected]) -> Self:
        """Learn from a block, but for what is known to have happened.

        Parameters
        ----------
        block
            Of sensors of the same names.
        known
            What that would make them read more.
        """
        heard = block.heard
        beside = self.expected(block).and_also(known)
        missed, noise = (block.error - beside.shift)[heard], beside.spread[np.ix_(heard, heard)]
        size, covariance = np.array(self.size), np.array(self.covariance)
        felt = self._felt(block)[heard]
        noise = noise - felt @ covariance @ felt.T
        covariance = covariance + (self._first() - covariance) / MEMORY
        size, covariance = learned(size, covariance, felt=felt, missed=missed, noise=noise)
        return replace(
            self,
            size=tuple(size.tolist()),
            covariance=_listed(covariance),
            restless=self._restless(block, missed, beside.spread[np.ix_(heard, heard)]),
        )

    def _restless(
        self, block: Block, missed: Float[np.ndarray, " row"], spread: Float[np.ndarray, "row row"]
    ) -> tuple[float, ...]:
        """Learn how large each sensor's own errors are: what the others do not explain of them."""
        after, heard = np.array(self.restless), block.heard
        known = np.linalg.inv(spread)
        alone = np.minimum((known @ missed) ** 2 / np.diag(known), WILD)
        after[heard] += (alone * self._wary()[heard] - after[heard]) / RESTLESS_MEMORY
        return tuple(after.tolist())

    def _wary(self) -> Float[np.ndarray, " sensor"]:
        """By how much more than the twin says each sensor's own variance is reckoned [-]."""
        return np.maximum(1.0, WARY * np.array(self.restless))

    def _first(self) -> Float[np.ndarray, "habit habit"]:
        return np.diag(np.repeat([OFF, DRAG], len(self.sensors)) ** 2)

    @staticmethod
    def _felt(block: Block) -> Float[np.ndarray, "sensor habit"]:
        return np.hstack([np.diag(block.own), np.diag(block.drag)])


def _listed(matrix: Float[np.ndarray, "habit habit"]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in matrix.tolist())
