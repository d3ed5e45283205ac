"""Forcing of a simulation: the waves and currents of each case, checked."""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from seacage.conventions import InputError
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.ocean import MODES_DEPTH, CurrentProfile, SeaState, Waves, over_depth, sample_waves

# Components of the waves of a case at most: the kernel keeps their phases on a thread's stack
MOST_COMPONENTS = 1000

# Shortest wave over the floating pipe's diameter for which Morison's equation holds [-]
LEAST_LENGTH = 8.0

# Share of Hs in shorter waves, beyond which an answer is outside the loads' validity [-]
MOST_LEFT_OUT = 0.05


def draw_waves(
    seas: list[SeaState],
    given: Waves | Sequence[Waves] | None,
    seed: int | Sequence[int],
    depth: float,
) -> list[Waves]:
    """One realisation for each case."""
    if given is not None:
        waves = [given] * len(seas) if isinstance(given, Waves) else list(given)
        if len(waves) != len(seas):
            raise InputError(
                f"simulate: {len(waves)} waves for {len(seas)} seas. Give one for each, or one."
            )
        return _check_waves(waves, depth)
    if isinstance(seed, (int, np.integer)):
        seeds = [int(seed) + i for i in range(len(seas))]
    else:
        seeds = list(seed)
    if len(seeds) != len(seas):
        raise InputError(
            f"simulate: {len(seeds)} seeds for {len(seas)} seas. Give one for each, or one number."
        )
    if min(seeds) < 0:
        raise InputError(f"simulate: seed = {min(seeds)} is negative. Give 0, 1, 2, …")
    return [sample_waves(s, seed=own, depth=depth) for s, own in zip(seas, seeds, strict=True)]


def _check_waves(waves: list[Waves], depth: float) -> list[Waves]:
    """The same waves, refused where the kernel cannot march through them."""
    for case, one in enumerate(waves):
        numbers = {name: getattr(one, name) for name in Waves.__slots__ if name != "depth"}
        for name, values in numbers.items():
            if not np.isfinite(values).all():
                worst = values[~np.isfinite(values)][0]
                raise InputError(
                    f"simulate: the waves of case {case} have {name} = {worst:g}. Leave out "
                    "components that are not finite."
                )
        if not math.isclose(one.depth, depth, rel_tol=1e-6):
            raise InputError(
                f"simulate: the waves of case {case} run in water of {one.depth:g} m, but the "
                f"site is {depth:g} m deep. Draw them with depth={depth:g}."
            )
        if np.abs(one.amplitude).sum() >= depth:
            raise InputError(
                f"simulate: the waves of case {case} can add up to "
                f"{np.abs(one.amplitude).sum():.3g} m, and their troughs would bare the bottom at "
                f"{depth:g} m. Give amplitudes in m that are smaller."
            )
        if len(one.amplitude) > MOST_COMPONENTS:
            raise InputError(
                f"simulate: the waves of case {case} have {len(one.amplitude)} components, of "
                f"which the kernel takes {MOST_COMPONENTS}. Draw fewer."
            )
    return waves


def morison_waves(
    waves: list[Waves], diameter: float
) -> tuple[list[Waves], Float[np.ndarray, " case"]]:
    """The waves that a floating pipe does not disturb, and the share of Hs that is left out [-].

    Morison's equation holds where a wave is long against the pipe: ``LEAST_LENGTH`` diameters,
    4 m or 1.6 s for pipes of 0.5 m. Shorter waves are scattered, and push the pipe by less
    than its displaced and added mass would have it.
    """
    kept = [one.longer(LEAST_LENGTH * diameter) for one in waves]
    share = [
        1.0 - math.sqrt(one.variance / whole.variance) if whole.variance > 0.0 else 0.0
        for one, whole in zip(kept, waves, strict=True)
    ]
    return kept, np.array(share)


def beyond_morison(
    left_out: Float[np.ndarray, " case"],
) -> tuple[Bool[np.ndarray, " case"], tuple[str, ...]]:
    """Cases of which more than a little of Hs is left out, and a sentence if there are any."""
    beyond = left_out > MOST_LEFT_OUT
    which = "" if len(beyond) == 1 else f"In {beyond.sum()} of {len(beyond)} cases up to "
    warning = (
        f"{which}{left_out.max():.0%} of Hs is in waves shorter than eight diameters of the "
        "collar's pipes, for which the loads are not valid; they are left out."
    )
    return beyond, (warning,) if beyond.any() else ()


def ocean_of(
    seas: list[SeaState], waves: list[Waves], profile: CurrentProfile | None, depth: float
) -> Ocean:
    surface = np.array([sea.current_velocity for sea in seas])
    shear = np.array([sea.shear_velocity for sea in seas])
    if shear.any():
        if profile is not None:
            raise InputError(
                "simulate: the sea has a shear, and current_profile says how the current changes "
                "with depth. Give one of them."
            )
        levels = np.array([0.0, MODES_DEPTH])
        current = over_depth(surface, shear, levels)
        return Ocean(waves=waves, current=current, level_z=-levels, depth=depth)
    current = surface[:, None] if profile is None else profile.velocity(surface)
    level_z = np.zeros(1) if profile is None else -np.array(profile.depth)
    return Ocean(waves=waves, current=current, level_z=level_z, depth=depth)
