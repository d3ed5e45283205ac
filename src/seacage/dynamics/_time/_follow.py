"""A cage followed through hours of changing weather, several stretches of time side by side."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, Progress, count_times
from seacage.dynamics._kernel._march import REFRESH
from seacage.dynamics._kernel._march_inputs import simulation_lanes
from seacage.dynamics._moored._detailed import Damage
from seacage.dynamics._physics._screens import Law, Tuning
from seacage.dynamics._time._segments import AbstractWeather, Build, Course, SegmentBatch
from seacage.dynamics._time._simulation import nodes_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Followed:
    """A cage along some stretches of time."""

    time: Float[np.ndarray, "stretch sample"]  # of the samples [s]
    # Of the nodes that were watched [m]
    watched_position: Float[np.ndarray, "stretch sample watched 3"]
    bridle_tension: Float[np.ndarray, "stretch sample bridle"]  # [N]
    shape: Float[np.ndarray, "stretch mean node 3"]  # mean positions over each ``shape_every`` [m]
    # When a stretch left the finite numbers, NaN where all is well [s]
    lost_at: Float[np.ndarray, " stretch"]


def follow(
    cage: Cage,
    weathers: Sequence[AbstractWeather],
    starts: Sequence[float],
    *,
    duration: float,
    every: float = 2.0,
    spin_up: float = 300.0,
    time_step: float = 0.001,
    law: Law = "loland",
    skin_friction: float | None = None,
    lift_factor: float = 1.0,
    stiffening: tuple[float, float] = (0.01, 0.5),
    watched: Sequence[int] = (),
    damaged: tuple[Damage, ...] = (),
    breaking: tuple[Damage, ...] = (),
    refined: int = 1,
    shape_nodes: Sequence[int] | None = None,
    shape_every: float = 600.0,
    progress: Progress | None = None,
) -> Followed:
    """March a cage through changing weather.

    As ``simulate``, with more of what a real cage has: current and growth that change as time
    goes on, a wake that each panel casts on what lies behind it along the current where the net
    now is, a sinker tube on ropes of its own, ropes that stiffen, frame, buoys and anchor lines.
    It starts from an equilibrium near by; nothing counts before ``spin_up``. A stretch's
    numbers do not depend on those beside it.

    Parameters
    ----------
    weathers, starts
        Of each stretch: what it meets, and from when it counts [s]; at most as many as
        ``simulation_lanes()``.
    duration
        That counts, of all stretches [s].
    every
        Between samples; the current is taken for the middle of each such time [s].
    spin_up
        Simulated before, in the weather before [s].
    time_step
        At most [s]. Light nodes are lent mass where the step needs it.
    law
        Of the netting. Twine by twine ("morison"), the facing half meets what momentum leaves
        of the current.
    skin_friction, lift_factor
        As for ``simulate``.
    stiffening
        As in ``full_assembly``: a strain, and the ropes' stiffness beyond it over the first.
    watched
        Nodes whose positions are sampled.
    damaged, breaking
        What is broken from the beginning, and what breaks when counting begins.
    refined
        Panels of this cage along the side of one that ``Damage`` counts in.
    shape_nodes
        Nodes whose means are kept; None for all.
    progress
        Called as ("follow", done, total), in simulated seconds of all stretches.

    Raises InputError: too many stretches or none, times that are no whole number of steps, damage
    to what the cage has not.
    """
    course = _course(duration, every, spin_up, shape_every, time_step)
    _check(weathers, starts)
    tuning = Tuning(skin_friction=skin_friction, lift_factor=lift_factor)
    build = Build(cage=cage, law=law, tuning=tuning, stiffening=stiffening, refined=refined)
    segments = SegmentBatch(build, weathers, np.array(starts, dtype=np.float64), course, damaged)
    march, kept = segments.march, nodes_of(cage, watched, "follow: watched")
    shaped = nodes_of(cage, shape_nodes, "follow: shape_nodes")
    place = np.empty((len(starts), course.samples, len(kept), 3))
    tension = np.empty((len(starts), course.samples, cage.bridle_count))
    shape: list[Float[np.ndarray, "stretch node 3"]] = []
    before = march.node_sum(shaped)
    for step in range(-course.spin_up, course.samples):
        if step == 0 and breaking:
            segments.breaks(damaged + breaking)
        segments.meets(step)
        if step >= 0:
            place[:, step], tension[:, step] = march.position_of(kept), segments.bridle_tension
        march.go(course.refreshes)
        if step >= 0 and (step + 1) % course.shape_samples == 0:
            now = march.node_sum(shaped)
            moved = (now - before) / (course.shape_samples * course.refreshes)
            shape.append(segments.assembly.position[shaped] + moved)
            before = now
        if progress is not None:
            done = (step + 1 + course.spin_up) * every * len(starts)
            progress("follow", round(done), round((spin_up + duration) * len(starts)))
    return Followed(
        time=segments.starts[:, None] + course.every * np.arange(course.samples),
        watched_position=place,
        bridle_tension=tension,
        shape=np.stack(shape, axis=1),
        lost_at=segments.starts - course.spin_up * course.every + march.lost_at,
    )


def _check(weathers: Sequence[AbstractWeather], starts: Sequence[float]) -> None:
    lanes = simulation_lanes()
    if not (1 <= len(starts) == len(weathers) <= lanes):
        raise InputError(
            f"follow: {len(weathers)} weathers and {len(starts)} starts. Give one of each for "
            f"every stretch, at least one and at most {lanes}."
        )
    if len({weather.level_depth for weather in weathers}) > 1:
        raise InputError("follow: the weathers have currents at other depths. Give equal depths.")


def _course(
    duration: float, every: float, spin_up: float, shape_every: float, time_step: float
) -> Course:
    refreshes = count_times(every, REFRESH, "follow: every")
    shape_samples = count_times(shape_every, every, "follow: shape_every")
    samples = count_times(duration, shape_every, "follow: duration") * shape_samples
    each = math.ceil(REFRESH / time_step - 1e-9) if time_step > 0.0 else 0
    if each < 1:
        raise InputError(f"follow: time_step = {time_step:g} s is no step. Give 0.001 s or less.")
    return Course(
        every=every,
        refreshes=refreshes,
        spin_up=count_times(spin_up, every, "follow: spin_up", least=0),
        samples=samples,
        shape_samples=shape_samples,
        steps=each,
    )
