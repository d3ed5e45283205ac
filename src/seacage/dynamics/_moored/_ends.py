"""Ends that are none of a moored, floating cage: under water, or held by nothing."""

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage, Structure
from seacage.conventions import Result, gravest
from seacage.dynamics._parts._assembly import Assembly

COLLAR_UNDER = 2.0  # depth of the collar's nodes in the mean beyond which a cage is drowned [m]
BUOY_UNDER = 0.1  # share of the time under water from which a buoy is drowned [-]
SLACK = 0.01  # tension over pretension below which a line is slack [-]


def mooring_result(
    cage: Cage | Structure,
    assembly: Assembly,
    result: Int[np.ndarray, " case"],
    collar_height: Float[np.ndarray, " case"],  # mean z of the collar's nodes [m]
    # At rest once, or at moments that stand for the whole time [N]
    line_tension: Float[np.ndarray, "t case line"],
) -> Int[np.ndarray, " case"]:
    """Each case's result, or what is graver: that it drowned, or that all its bridles are slack.

    A buoy is wholly under water where its line bears all its buoyancy. A structure, which may be
    built under water, is never drowned, and it is not known when its lines are slack.
    """
    if isinstance(cage, Structure):
        return result
    bridles, bars = len(assembly.bridles), len(assembly.line_bars)
    buoyancy = assembly.floats.rows(assembly.line_floats).buoyancy
    under = line_tension[..., bars:] >= (1.0 - 1e-6) * buoyancy  # as single precision rounds both
    under &= buoyancy > 0.0  # a buoy whose line has parted floats
    drowned = np.any(under.mean(axis=0) >= BUOY_UNDER, axis=1) | (collar_height < -COLLAR_UNDER)
    slack = SLACK * assembly.lines.pretension[:bridles]
    held = np.any(line_tension[..., :bridles].max(axis=0) >= slack, axis=1)
    return gravest(result, {Result.DROWNED: drowned, Result.SLACK: ~held})
