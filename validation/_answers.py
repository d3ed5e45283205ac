"""What a cage or a structure does in a sea, settled or on average in time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, Structure
from seacage.conventions import Result
from seacage.dynamics import LAWS, History, MovingLaw, Response, settle, simulate
from seacage.ocean import SeaState
from validation._present_area import settle_on_present_area


@dataclass(frozen=True, slots=True, kw_only=True)
class How:
    """How the cages of a case are solved; times count where they are simulated [s].

    ``present_area`` is for the equilibria of a model that loads the area a panel now has.
    """

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
    """Shape [m], shape in still water [m], the net's load [N], tensions [N], volumes [m3]."""

    position: Float[np.ndarray, "node 3"]
    rest: Float[np.ndarray, "node 3"]
    net_force: Float[np.ndarray, "3"]
    tension: Float[np.ndarray, " line"]
    volume: float
    rest_volume: float


def answers(
    subject: Cage | Structure, seas: Sequence[SeaState], law: MovingLaw, how: How
) -> list[Answer | None]:
    """One for each sea; None where there is no equilibrium to be had.

    A cage in currents alone is settled; waves, a structure and twine by twine are simulated,
    and their means taken.
    """
    waves = any(sea.hs > 0.0 for sea in seas)
    if isinstance(subject, Structure) or law not in LAWS or waves:
        return _simulated(subject, seas, law, how)
    response = (settle_on_present_area if how.present_area else settle)(
        subject,
        seas,
        law=law,
        mooring="springs",  # a tank has no anchor lines
        hold_collar=how.hold_collar,
        collar_drag=how.pipe_drag,
        wake=how.wake,
    )
    return [_settled(response, case) for case in range(len(seas))]


def _settled(response: Response, case: int) -> Answer | None:
    if response.result[case] != Result.CONVERGED:
        return None  # a shape that is not at rest proves nothing
    position, volume = response.node_position[case], float(response.volume[case])
    return Answer(
        position=position,
        rest=position - response.node_displacement[case],
        net_force=response.net_force[case],
        tension=response.bridle_tension[case],
        volume=volume,
        rest_volume=volume / float(response.volume_fraction[case]),
    )


def _simulated(
    subject: Cage | Structure, seas: Sequence[SeaState], law: MovingLaw, how: How
) -> list[Answer | None]:
    """With still water as one case more: a structure's rest is not known otherwise."""
    history = simulate(
        subject,
        [*seas, SeaState(current_speed=0.0, current_to=0.0)],
        law=law,
        twine_drag=how.twine_drag if law == "morison" else None,
        mooring="springs" if isinstance(subject, Cage) else "catenary",
        hold_collar=how.hold_collar,
        collar_drag=how.pipe_drag,
        wake=how.wake,
        spin_up=how.spin_up,
        ramp=min(60.0, how.spin_up),
        duration=how.duration,
        time_step=how.time_step,
        sample_every=None,
    )
    return [_mean(history, case) for case in range(len(seas))]


def _mean(history: History, case: int) -> Answer | None:
    if history.result[case] != Result.CONVERGED or history.result[-1] != Result.CONVERGED:
        return None
    return Answer(
        position=history.node.mean[case],
        rest=history.node.mean[-1],
        net_force=history.net_force.mean[case],
        tension=history.bridle.mean[case],
        volume=float(history.volume.mean[case]),
        rest_volume=float(history.volume.mean[-1]),
    )
