"""Waves from more than one direction, and waves that a current carries."""

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage.ocean._kinematics import BAND, Waves, bin_energy, wavenumber
from seacage.ocean._sea_state import SeaState

_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WaveDraw:
    """All that chance decides about spread waves, for whatever sea they make up.

    A sea that changes slowly keeps its draw, so that its waves stay the same ones.
    """

    frequency: Float[np.ndarray, " wave"]  # over the peak's, one in each bin [-]
    phase: Float[np.ndarray, " wave"]  # at the origin at time 0 [rad]
    turned: Float[np.ndarray, " wave"]  # clockwise from the sea's direction [rad]

    @classmethod
    def sample(cls, rng: np.random.Generator, *, components: int, spreading: float) -> Self:
        """Draw frequencies, phases and directions.

        Each frequency is random in a bin of its own. Directions follow the golden section from
        a random one, so that neighbours in frequency cover the spread between them.

        ``rng``: source of chance.
        ``components``: how many waves.
        ``spreading``: as for ``spread_angle``.
        """
        edges = np.linspace(*BAND, components + 1)
        share = (rng.random() + _GOLDEN * np.arange(components)) % 1.0
        return cls(
            frequency=edges[:-1] + rng.random(components) * np.diff(edges),
            phase=rng.uniform(0.0, 2.0 * math.pi, components),
            turned=spread_angle(share, spreading=spreading),
        )

    def waves(self, sea: SeaState, *, depth: float) -> Waves:
        """Make up a sea in water of some depth [m].

        Each carries the energy of its bin, as in ``sample_waves``.
        """
        peak = 2.0 * math.pi / sea.peak_period if sea.hs > 0.0 else 1.0
        frequency = peak * self.frequency
        energy = bin_energy(sea, peak * np.linspace(*BAND, len(frequency) + 1))
        return Waves(
            amplitude=np.sqrt(2.0 * energy),
            angular_frequency=frequency,
            wavenumber=wavenumber(frequency, depth=depth),
            phase=self.phase,
            direction=turn_vectors(sea.wave_direction, self.turned),
            depth=depth,
        )


def spread_angle(share: Float[np.ndarray, " n"], *, spreading: float) -> Float[np.ndarray, " n"]:
    """Angle off a sea's direction that leaves a share of the energy on its left [rad].

    ``share``: from 0 to 1; 0.5 is straight ahead [-]. ``spreading``: s of cos^2s of half the angle:
    about 10 for wind sea at its peak, more for swell [-].

    Source: Longuet-Higgins, Cartwright and Smith (1963); values of s: Mitsuyasu et al. (1975).
    """
    from scipy.special import betaincinv

    # With a = angle / 2 the energy goes as cos^2s a, so sin^2 a is distributed as Beta(1/2, s+1/2).
    off = betaincinv(0.5, spreading + 0.5, np.abs(2.0 * share - 1.0))
    return 2.0 * np.sign(share - 0.5) * np.arcsin(np.sqrt(off))


def turn_vectors(
    direction: Float[np.ndarray, "*#n 2"], clockwise: Float[np.ndarray, "*#n"]
) -> Float[np.ndarray, "*n 2"]:
    """Vectors (east, north), turned clockwise by angles [rad]."""
    east, north = direction[..., 0], direction[..., 1]
    cosine, sine = np.cos(clockwise), np.sin(clockwise)
    return np.stack([cosine * east + sine * north, cosine * north - sine * east], axis=-1)


def on_current(waves: Waves, current: Float[np.ndarray, "2"]) -> Waves:
    """Waves on a current, as seen from a fixed place: those that run with it pass faster.

    The water's motion under them stays as it was. Left out: what a current does to heights.

    ``waves``: with frequencies as in still water. ``current``: at the surface, (east, north) [m/s].

    Source: omega = sigma + k . U, as in Peregrine (1976).
    """
    doppler = waves.wavenumber * (waves.direction @ current)
    return replace(waves, angular_frequency=waves.angular_frequency + doppler)
