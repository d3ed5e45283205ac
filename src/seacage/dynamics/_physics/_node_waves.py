"""The waves that a node of the mesh feels: those that reach it, averaged over its piece of net."""

import math
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from seacage.ocean import Waves

FELT = 1e-4
"""Speed of a component that is not felt, over that of all at the surface, root mean square [-]."""

UNFELT = 1e9
"""Reach of a component that is felt nowhere: above all nodes [m]."""


def wave_reach(waves: Waves) -> Float[np.ndarray, " wave"]:
    """Height below which each component moves the water too little to be felt [m].

    That is by ``FELT`` of the root-mean-square speed at the surface, in a trough four standard
    deviations deep. Such components are left out of the motion there, and of its stretching.
    """
    speed = waves.amplitude * waves.intrinsic_frequency
    least = FELT * math.sqrt(float(np.sum(speed**2)) / 2.0)
    trough = 4.0 * math.sqrt(float(np.sum(waves.amplitude**2)) / 2.0)
    felt = speed > least
    reach = np.full_like(speed, UNFELT)
    reach[felt] = np.log(least / speed[felt]) / waves.wavenumber[felt] - trough
    return reach


def node_waves(waves: Waves, height: float, chord: Float[np.ndarray, "2"]) -> Waves:
    """The components that a node at some height feels, each averaged over the node's chord.

    A node stands for the piece of ring between it and its neighbours. A wave that is short
    against that piece pushes and pulls on it at once: its mean over the piece is its value in
    the middle times sin(x)/x, with x half the wave's phase along it. A wave shorter than the
    piece is left out; without the mean it would act on the mesh as a long one.

    Parameters
    ----------
    waves
        Of the sea.
    height
        Of the node over still water [m].
    chord
        Horizontal, as designed; zero for a node that stands for a point [m].
    """
    turns = waves.wavenumber * (waves.direction @ chord) / (2.0 * np.pi)
    mean = np.where(np.abs(turns) < 1.0, np.sinc(turns), 0.0)
    felt = height > wave_reach(waves)
    return replace(waves, amplitude=waves.amplitude * mean * felt)
