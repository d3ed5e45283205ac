"""What a cage or a structure does in a sea, settled or on average in time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, Structure
from seacage.conventions import has_answer
from seacage.dynamics import LAWS, History, Law, Mooring, Response, settle, simulate
from seacage.ocean import SeaState, Waves, regular_wave, sample_waves
from validation._present_area import settle_on_present_area


@dataclass(frozen=True, slots=True, kw_only=True)
class Water:
    """A sea, or its current with one regular wave [m, s] that comes from the sea's direction."""

    sea: SeaState
    height: float = 0.0
    period: float = 0.0

    @property
    def has_waves(self) -> bool:
        """Whether an equilibrium is no answer."""
        return self.sea.hs > 0.0 or self.height > 0.0

    def waves(self, seed: int, depth: float) -> Waves:
        """The regular wave, or one draw from the sea's spectrum."""
        if self.height == 0.0:
            return sample_waves(self.sea, seed=seed, depth=depth)
        return regular_wave(
            height=self.height, period=self.period, wave_from=self.sea.wave_from, depth=depth
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class How:
    """How the cages of a case are solved; times count where they are simulated [s].

    ``mooring`` is a cage's, for a structure has its own. ``present_area`` is for the equilibria
    of a model that loads the area a panel now has.
    """

    mooring: Mooring
    hold_collar: bool
    pipe_drag: bool
    wake: bool
    present_area: bool
    twine_drag: tuple[float, float] | None
    spin_up: float
    duration: float
    time_step: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """Shape [m], shape in still water [m], the net's load [N], tensions [N], volumes [m3].

    Tensions are of all lines, the bridles first, each its mean, standard deviation and maximum;
    of an equilibrium the last is the mean.
    """

    position: Float[np.ndarray, "node 3"]
    rest: Float[np.ndarray, "node 3"]
    net_force: Float[np.ndarray, "3"]
    tension: Float[np.ndarray, " line"]
    tension_std: Float[np.ndarray, " line"]
    tension_maximum: Float[np.ndarray, " line"]
    volume: float
    rest_volume: float


def answers(
    subject: Cage | Structure, waters: Sequence[Water], law: Law, how: How
) -> list[Answer | None]:
    """One for each water; None where there is no equilibrium to be had.

    A cage in currents alone is settled; waves, a structure and twine by twine are simulated,
    and their means taken.
    """
    waves = any(water.has_waves for water in waters)
    if isinstance(subject, Structure) or law not in LAWS or waves:
        return _simulated(subject, waters, law, how)
    response = (settle_on_present_area if how.present_area else settle)(
        subject,
        [water.sea for water in waters],
        law=law,
        mooring=how.mooring,
        hold_collar=how.hold_collar,
        collar_drag=how.pipe_drag,
        wake=how.wake,
    )
    return [_settled(response, case) for case in range(len(waters))]


def _settled(response: Response, case: int) -> Answer | None:
    if not has_answer(response.result)[case]:
        return None  # a shape that is not at rest proves nothing
    position, volume = response.node_position[case], float(response.volume[case])
    tension = response.line_tension[case]
    return Answer(
        position=position,
        rest=position - response.node_displacement[case],
        net_force=response.net_force[case],
        tension=tension,
        tension_std=np.zeros_like(tension),
        tension_maximum=tension,
        volume=volume,
        rest_volume=volume / float(response.volume_fraction[case]),
    )


def _simulated(
    subject: Cage | Structure, waters: Sequence[Water], law: Law, how: How
) -> list[Answer | None]:
    """With still water as one case more: a structure's rest is not known otherwise."""
    every = [*waters, Water(sea=SeaState(current_speed=0.0, current_to=0.0))]
    depth = subject.site.water_depth
    history = simulate(
        subject,
        [water.sea for water in every],
        waves=[water.waves(seed, depth) for seed, water in enumerate(every)],
        law=law,
        mooring=how.mooring,
        twine_drag=how.twine_drag if law == "morison" else None,
        hold_collar=how.hold_collar,
        collar_drag=how.pipe_drag,
        wake=how.wake,
        spin_up=how.spin_up,
        ramp=min(60.0, how.spin_up),
        duration=how.duration,
        time_step=how.time_step,
        sample_every=None,
    )
    return [_mean(history, case) for case in range(len(waters))]


def _mean(history: History, case: int) -> Answer | None:
    if not has_answer(history.result)[[case, -1]].all():
        return None
    tension = history.lines.tension
    return Answer(
        position=history.node.mean[case],
        rest=history.node.mean[-1],
        net_force=history.net_force.mean[case],
        tension=tension.mean[case],
        tension_std=tension.std[case],
        tension_maximum=tension.maximum[case],
        volume=float(history.volume.mean[case]),
        rest_volume=float(history.volume.mean[-1]),
    )
