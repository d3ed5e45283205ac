"""From a sea state to the steady flow on each panel: wake, law and mean effect of waves."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import DYNAMIC, SteadyFlow
from seacage.dynamics._physics._screens import AS_PUBLISHED, Law, Screen, Tuning, law_of_each
from seacage.dynamics._physics._wake import downstream, wake_factor
from seacage.ocean import over_depth


def steady_flow(
    assembly: Assembly,
    current_velocity: Float[np.ndarray, "case 2"],
    *,
    law: Law | Sequence[Law],
    wake: bool = True,
    pipe_drag: bool = True,
    wave_variance: Float[np.ndarray, "case panel"] | None = None,
    shear: Float[np.ndarray, "case 2"] | None = None,
    tuning: Tuning = AS_PUBLISHED,
) -> SteadyFlow:
    """Steady flow on each panel in a current and, if given, waves.

    ``current_velocity``: east and north [m/s]. ``law``: the screen law, one for all cases or one
    for each. ``wake``: whether the down-stream half of the net meets slower water. ``pipe_drag``:
    whether the current drags on collar and sinker tube. ``wave_variance``: of the waves' horizontal
    velocity at each panel [m2/s2]. Their mean effect on a net that stands still is taken as
    stochastic linearisation gives it, with |u| raised to sqrt(|u|² + 8σ²/π). A net that follows the
    water feels less. ``shear``: of the current over depth, its mean then being
    ``current_velocity``, as ``ocean.over_depth`` has them [m/s]; None for a uniform one. Panels and
    pipes meet the current of the depth that they are designed for. ``tuning``: what is changed of
    the law.

    Source: Borgman (1967) for the linearised drag of a Gaussian sea.
    """
    laws: tuple[Law, ...] = law_of_each(law, len(current_velocity))
    panels = assembly.panels
    speed = np.linalg.norm(current_velocity, axis=1)
    unit = current_velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
    behind = downstream(panels, unit[:, None]) if wake else np.zeros((len(speed), len(panels.area)))
    by_part = None
    if shear is not None:  # at the design depth of each panel and of each pipe
        depths = (panels.depth, -assembly.position[assembly.cylinders.ends, 2].mean(axis=1))
        by_part = [over_depth(current_velocity, shear, depth) for depth in depths]
    variance = np.zeros_like(behind) if wave_variance is None else wave_variance

    def flow_of(law: Law, some: Int[np.ndarray, " some"]) -> SteadyFlow:
        screen = Screen(
            law=law, solidity=panels.solidity, twine_diameter=panels.twine_diameter, tuning=tuning
        )
        panel_speed = np.tile(speed[some, None], (1, len(screen.solidity)))
        pipe_speed, own = speed[some, None], dict[str, np.ndarray]()
        if by_part is not None:
            (panel_speed, at_panels), (pipe_speed, at_pipes) = (
                _speed_and_way(one[some]) for one in by_part
            )
            own = {"panel_direction": at_panels, "pipe_direction": at_pipes}
        panel_speed *= 1.0 - (1.0 - wake_factor(screen, panel_speed)) * behind[some]
        felt = np.sqrt(panel_speed**2 + 8.0 / np.pi * variance[some])
        return SteadyFlow(
            direction=np.column_stack([unit[some], np.zeros(len(some))]),
            pressure=DYNAMIC * felt * panel_speed,
            pipe_pressure=DYNAMIC * pipe_speed**2 * float(pipe_drag),
            **own,
            **screen.terms(felt),
        )

    kinds: tuple[Law, ...] = tuple(dict.fromkeys(laws))
    cases = [np.flatnonzero([each == kind for each in laws]) for kind in kinds]
    return SteadyFlow.joined(*map(flow_of, kinds, cases)).rows(np.argsort(np.concatenate(cases)))


def _speed_and_way(
    velocity: Float[np.ndarray, "case part 2"],
) -> tuple[Float[np.ndarray, "case part"], Float[np.ndarray, "case part 3"]]:
    speed = np.linalg.norm(velocity, axis=-1)
    unit = velocity / np.where(speed > 0.0, speed, 1.0)[..., None]
    return speed, np.concatenate([unit, np.zeros_like(unit[..., :1])], axis=-1)
