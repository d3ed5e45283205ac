"""From a sea state to the steady flow on each panel: wake, law and mean effect of waves."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Int

from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._loads import DYNAMIC, SteadyFlow
from seacage.dynamics._physics._screens import AS_PUBLISHED, Law, Screen, Tuning
from seacage.dynamics._physics._wake import downstream, wake_factor


def flow_of_laws(
    assembly: Assembly,
    current_velocity: Float[np.ndarray, "case 2"],
    *,
    laws: Sequence[Law],
    wake: bool = True,
    pipe_drag: bool = True,
    wave_variance: Float[np.ndarray, "case panel"] | None = None,
    tuning: Tuning = AS_PUBLISHED,
) -> SteadyFlow:
    """``steady_flow`` with a law for each case."""

    def of(law: Law, some: Int[np.ndarray, " some"]) -> SteadyFlow:
        return steady_flow(
            assembly,
            current_velocity[some],
            law=law,
            wake=wake,
            pipe_drag=pipe_drag,
            wave_variance=None if wave_variance is None else wave_variance[some],
            tuning=tuning,
        )

    flow = of(laws[0], np.arange(len(laws)))
    for law in dict.fromkeys(laws[1:]):
        some = np.flatnonzero([one == law for one in laws])
        flow.take(some, of(law, some))
    return flow


def steady_flow(
    assembly: Assembly,
    current_velocity: Float[np.ndarray, "case 2"],
    *,
    law: Law,
    wake: bool = True,
    pipe_drag: bool = True,
    wave_variance: Float[np.ndarray, "case panel"] | None = None,
    tuning: Tuning = AS_PUBLISHED,
) -> SteadyFlow:
    """Steady flow on each panel in a uniform current and, if given, waves.

    ``current_velocity``: east and north [m/s]. ``law``: the screen law. ``wake``: whether the
    down-stream half of the net meets slower water. ``pipe_drag``: whether the current drags on
    collar and sinker tube. ``wave_variance``: of the waves' horizontal velocity at each panel
    [m2/s2]. Their mean effect on a net that stands still is taken as stochastic linearisation gives
    it, with |u| raised to sqrt(|u|² + 8σ²/π). A net that follows the water feels less. ``tuning``:
    what is changed of the law.

    Source: Borgman (1967) for the linearised drag of a Gaussian sea.
    """
    panels = assembly.panels
    screen = Screen(
        law=law, solidity=panels.solidity, twine_diameter=panels.twine_diameter, tuning=tuning
    )
    speed = np.linalg.norm(current_velocity, axis=1)
    unit = current_velocity / np.where(speed > 0.0, speed, 1.0)[:, None]
    direction = np.column_stack([unit, np.zeros(len(speed))])
    panel_speed = np.tile(speed[:, None], (1, len(screen.solidity)))
    if wake:
        behind = downstream(panels, unit[:, None])
        panel_speed *= 1.0 - (1.0 - wake_factor(screen, panel_speed)) * behind
    variance = 0.0 if wave_variance is None else wave_variance
    felt = np.sqrt(panel_speed**2 + 8.0 / np.pi * variance)
    return SteadyFlow(
        direction=direction,
        pressure=DYNAMIC * felt * panel_speed,
        pipe_pressure=DYNAMIC * speed**2 * float(pipe_drag),
        **screen.terms(felt),
    )
