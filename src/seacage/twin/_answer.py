"""A twin's answer: loads, depths and shape of a cage, with intervals and validity."""

from dataclasses import dataclass, fields, replace
from itertools import chain
from typing import Any, Self

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import Rows
from seacage.surrogates import Loads, Prediction

Interval = tuple[Float[np.ndarray, "case output"], Float[np.ndarray, "case output"]]
PerNode = Float[np.ndarray, "case node 3"]
INTERVAL_SD = 1.96  # half the width of an interval, in standard deviations; it holds 95 %

# How the names of those fields end that are the same in all rows
SAME_IN_ALL_ROWS = ("_names", "_units", "_kinds", "_level", "_calibrated")

# Why an answer of level 1 has no interval
NO_INTERVAL = "No sensor has trained level 2: how far the simulation is from the sea is not known."


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answer:
    """The cage's response to each row of metocean input.

    A row that is not valid holds NaN in every number, and ``reason`` says why; a door writes
    such a number as nothing at all.
    """

    valid: Bool[np.ndarray, " case"]  # the input was there, passed its checks and was fresh
    # The input lies inside what level 1 was trained on; False means extrapolating
    in_domain: Bool[np.ndarray, " case"]
    # The same of the level that predicts: level 2 has a domain of its own, of the water in its
    # training window, within level 1's
    bridle_in_domain: Bool[np.ndarray, "case line"]
    sensor_in_domain: Bool[np.ndarray, "case sensor"]
    reason: tuple[str, ...]  # one sentence where a row is not valid or extrapolates, else ""
    bridle_names: tuple[str, ...]
    bridle_tension: Prediction  # best mean and standard deviation [N]
    bridle_low: Float[np.ndarray, "case line"]  # the simulations alone [N]
    bridle_level: Int[np.ndarray, " line"]  # 2 where a shackle has a level-2 model, else 1
    # Whether the standard deviation is about the true tension: at level 2, and at level 1 with the
    # discrepancy of the simulations that at least three other shackles show. Elsewhere it is the
    # emulator's own, about the simulations.
    bridle_calibrated: Bool[np.ndarray, " line"]
    sensor_names: tuple[str, ...]
    sensor_units: tuple[str, ...]
    # Predicted reading of each sensor, with the scatter of its readings [N] or [m] depth. The
    # standard deviation at level 2 is calibrated: mean ± 1.96 of it has a coverage of 95 %. At
    # level 1 it is the emulator's own.
    sensor: Prediction
    # The simulations alone at the sensor's place, with the emulator's spread [N] or [m]
    sensor_low: Prediction
    sensor_level: Int[np.ndarray, " sensor"]
    node_position: PerNode  # best mean of the whole net [m], x east, y north, z up
    # Largest standard deviation over the axes of each node [m], the emulator's own
    node_sigma: Float[np.ndarray, "case node"]
    # Standard deviation of the true net about that mean, along the axes [m]; NaN at level 1
    node_std: PerNode
    shape_level: int  # 2 where at least two depth sensors correct the net, else 1
    # Volume over the same model's volume in still water [-], and its standard deviation about the
    # true one; NaN at level 1
    volume_fraction: Float[np.ndarray, " case"]
    volume_std: Float[np.ndarray, " case"]
    # All lines of the mooring, the bridles first; none where the twin did not learn loads in waves
    line_names: tuple[str, ...] = ()
    line_kinds: tuple[str, ...] = ()
    # Their loads in waves; None as above. At level 2 the intervals of mean and standard deviation
    # hold the ones of ten minutes, of lines whose held-out windows were enough to calibrate them.
    # Other bridles have intervals where at least three shackles show how far level 1 is off, other
    # lines NaN. Where the waves are not known the standard deviation of the mean is its spread
    # over the site's waves, at level 1.
    line: Loads | None = None
    line_level: Int[np.ndarray, " mooring_line"]  # 2 where its shackle corrects any load, else 1
    # Whether a line has intervals about its true loads: at level 2, and bridles at level 1 as above
    line_calibrated: Bool[np.ndarray, " mooring_line"]
    # Whether the water is inside what the loads were learned in, and one sentence where there are
    # none or they are extrapolated, else ""
    line_in_domain: Bool[np.ndarray, " case"]
    line_reason: tuple[str, ...]
    # Whether Tp was not known, and the loads are over its distribution at the same Hs
    line_tp_assumed: Bool[np.ndarray, " case"]
    # Standard deviations of each node's place in waves, horizontally (of both axes together) and
    # upwards, of half an hour, at level 1 [m]; NaN as ``line`` where the waves are not known, None
    # where they were not learned
    node_motion: Float[np.ndarray, "case node 2"] | None = None
    # Standard deviation of each depth sensor's depth in waves [m], and 2 where its windows correct
    # it, else 1
    depth_std: Float[np.ndarray, "case depth"]
    depth_std_level: Int[np.ndarray, " depth"]

    def __len__(self) -> int:
        return len(self.valid)

    @classmethod
    def join(cls, *answers: Self) -> Self:
        """All rows of several answers of one twin, one after another."""
        rows = {
            one.name: _join([getattr(answer, one.name) for answer in answers])
            for one in fields(cls)
            if not one.name.endswith(SAME_IN_ALL_ROWS)
        }
        return replace(answers[0], **rows)

    def without_nodes(self) -> Self:
        """Return the same without where the nodes are, which is most of its memory."""
        rows = len(self)
        return replace(
            self,
            node_position=np.empty((rows, 0, 3)),
            node_sigma=np.empty((rows, 0)),
            node_std=np.empty((rows, 0, 3)),
            node_motion=None,
        )

    def widened(
        self, *, bridle: Float[np.ndarray, " line"], sensor: Float[np.ndarray, " sensor"]
    ) -> Self:
        """Return the same with standard deviations times factors [-]; means and shape stay."""
        line = self.line
        if line is not None:
            factor = np.ones(len(self.line_names))
            factor[: len(bridle)] = bridle
            line = replace(line, mean=replace(line.mean, std=line.mean.std * factor))
        return replace(
            self,
            line=line,
            bridle_tension=replace(self.bridle_tension, std=self.bridle_tension.std * bridle),
            sensor=replace(self.sensor, std=self.sensor.std * sensor),
        )

    def maximum_interval(self) -> Interval:
        """Interval of the lines' largest loads of three hours that holds 95 % [N]; NaN without.

        Computed for the lines that have one alone, as it takes longer than all the means.
        """
        ends = np.full((2, len(self), len(self.line_names)), np.nan)
        known = np.flatnonzero(self.line_calibrated)
        if self.line is not None and len(known):
            ends[:, :, known] = self.line.maximum_3h.lines(known).interval(0.95)
        return ends[0], ends[1]

    def bridle_interval(self) -> Interval:
        """Interval of the tensions that holds 95 % [N]; NaN where none is calibrated."""
        return _interval(self.bridle_tension, self.bridle_calibrated)

    def node_interval(self) -> tuple[PerNode, PerNode]:
        """Interval of each node's x, y and z that holds 95 % [m]; NaN at level 1."""
        half = INTERVAL_SD * self.node_std
        return self.node_position - half, self.node_position + half

    def volume_interval(self) -> tuple[Float[np.ndarray, " case"], Float[np.ndarray, " case"]]:
        """Interval of the volume fraction that holds 95 % [-]; NaN at level 1."""
        half = INTERVAL_SD * self.volume_std
        return np.maximum(self.volume_fraction - half, 0.0), self.volume_fraction + half

    def sensor_interval(self) -> Interval:
        """Interval of the readings that holds 95 % [N] or [m]; NaN at level 1."""
        return _interval(self.sensor, self.sensor_level > 1)


def interval_reason(*, known: bool) -> str | None:
    """Why an answer has no interval; None where one is known."""
    return None if known else NO_INTERVAL


def _join(parts: list[Any]) -> Any:
    if parts[0] is None:
        return None
    if isinstance(parts[0], Rows):
        return parts[0].joined(*parts)
    if isinstance(parts[0], np.ndarray):
        return np.concatenate(parts)
    return tuple(chain.from_iterable(parts))


def _interval(prediction: Prediction, known: Bool[np.ndarray, " output"]) -> Interval:
    half = np.where(known, INTERVAL_SD * prediction.std, np.nan)
    # A rope never pushes, and no sensor hangs above the surface.
    lower, upper = (np.maximum(prediction.mean + end, 0.0) for end in (-half, half))
    return lower, upper
