"""The waves that a node of the mesh feels, in NumPy: what the kernel is held against."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from seacage.dynamics._kernel._march_inputs import wave_reach
from seacage.ocean import Waves


def node_waves(waves: Waves, height: float, chord: Float[np.ndarray, "2"]) -> Waves:
    """The components that a node at some height feels, each averaged over the node's chord.

    A node stands for the piece of ring between it and its neighbours. A wave that is short
    against that piece pushes and pulls on it at once: its mean over the piece is its value in
    the middle times sin(x)/x, with x half the wave's phase along it. A wave shorter than the
    piece is left out; without the mean it would act on the mesh as a long one.

    ``waves``: of the sea. ``height``: of the node over still water [m]. ``chord``: horizontal, as
    designed; zero for a node that stands for a point [m].
    """
    turns = waves.wavenumber * (waves.direction @ chord) / (2.0 * np.pi)
    mean = np.where(np.abs(turns) < 1.0, np.sinc(turns), 0.0)
    felt = height > wave_reach(waves)
    return replace(waves, amplitude=waves.amplitude * mean * felt)
