"""Linear waves in water of finite depth, and the motion of the water under them."""

import math
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from seacage.conventions import GRAVITY, InputError, Rows, fold_degrees, towards
from seacage.ocean._sea_state import SeaState
from seacage.ocean._spectrum import spectrum

N2 = Float[np.ndarray, "*#n 2"]
N3 = Float[np.ndarray, "*#n 3"]
NWave = Float[np.ndarray, "*n wave"]
PerN = Float[np.ndarray, "*n"]
# The components' frequencies, over the peak's: all but 0.5 % of the energy, and nearly all of the
# motion below the first metre
BAND = (0.5, 4.0)


def wavenumber(angular_frequency: PerN, *, depth: float) -> PerN:
    """Wave number of a linear wave: the root k of omega^2 = g k tanh(k depth) [1/m].

    ``angular_frequency``: at least 0 [rad/s].
    ``depth``: of the water [m].

    Source: start by Eckart (1952), within 5 %; then Newton, which doubles the digits each time.
    """
    deep = angular_frequency**2 * depth / GRAVITY
    kh = np.where(deep > 0.0, deep / np.sqrt(np.tanh(np.where(deep > 0.0, deep, 1.0))), 0.0)
    for _ in range(5):
        tanh = np.tanh(kh)
        slope = tanh + kh * (1.0 - tanh**2)
        kh -= (kh * tanh - deep) / np.where(slope > 0.0, slope, 1.0)
    return kh / depth


@dataclass(frozen=True, slots=True, kw_only=True)
class Waves(Rows):
    """A sum of linear waves, each long-crested."""

    amplitude: Float[np.ndarray, " wave"]  # [m]
    angular_frequency: Float[np.ndarray, " wave"]  # as seen from a fixed place [rad/s]
    # [1/m]. It says how the water moves, also where a current carries the wave past faster
    wavenumber: Float[np.ndarray, " wave"]
    phase: Float[np.ndarray, " wave"]  # at the origin at time 0 [rad]
    direction: Float[np.ndarray, "wave 2"]  # unit vector that each travels along, (east, north) [-]
    depth: float  # of the water [m]

    @property
    def intrinsic_frequency(self) -> Float[np.ndarray, " wave"]:
        """As seen by who drifts with the water, by the dispersion relation [rad/s]."""
        k = self.wavenumber
        return np.sqrt(GRAVITY * k * np.tanh(k * self.depth))

    def shifted(self, seconds: float) -> "Waves":
        """The same waves, so much later: their time 0 is then."""
        return replace(self, phase=self.phase - seconds * self.angular_frequency)

    def longer(self, shortest: float) -> "Waves":
        """The components at least so long [m]."""
        return self.rows(self.wavenumber * shortest <= 2.0 * np.pi)

    @property
    def variance(self) -> float:
        """Of the surface [m2]."""
        return float(np.sum(self.amplitude**2)) / 2.0


def sample_waves(sea: SeaState, *, seed: int, components: int = 200, depth: float = 191.0) -> Waves:
    """Draw one realisation of a sea's waves.

    Each component carries the energy of its own bin of frequency, so that their sum is that of
    the sea; its frequency is random in the bin, so that the sea does not repeat, and so is its
    phase. Bins are narrow where the energy is (``frequency_bins``). Amplitudes are not random:
    half-hours of 200 components differ in Hs by 1.4 % (standard deviation, Tp 7 s), those of a
    Gaussian sea by 3.0 %. Left out: spreading of direction, and waves shorter than a quarter of
    the peak's period. Without waves every amplitude is 0.

    Parameters
    ----------
    sea
        What to realise.
    seed
        The same seed gives the same sea.
    components
        How many waves. With 200 the largest crest of half an hour is that of a Gaussian sea
        within 1 % in the mean; with 30 it is 3 % low.
    depth
        Of the water [m].
    """
    random = np.random.default_rng(seed)
    edges = frequency_bins(sea, components)
    frequency = edges[:-1] + random.random(components) * np.diff(edges)
    energy = bin_energy(sea, edges)
    return Waves(
        amplitude=np.sqrt(2.0 * energy),
        angular_frequency=frequency,
        wavenumber=wavenumber(frequency, depth=depth),
        phase=random.uniform(0.0, 2.0 * math.pi, components),
        direction=np.tile(sea.wave_direction, (components, 1)),
        depth=depth,
    )


def frequency_bins(sea: SeaState, components: int) -> Float[np.ndarray, " edge"]:
    """Edges of the components' bins [rad/s].

    Half of a bin's share is of the energy, half of the width of the band: equal widths leave
    few components under the peak, and crests too alike; equal energies leave one for the whole
    tail, which moves the water fastest.
    """
    # A flat sea keeps its components, at frequencies that no amplitude needs.
    if sea.hs == 0.0:
        return np.linspace(*BAND, components + 1)
    fine = 2.0 * math.pi / sea.peak_period * np.linspace(*BAND, 2001)
    energy = np.append(0.0, np.cumsum(bin_energy(sea, fine)))
    share = (energy / energy[-1] + np.linspace(0.0, 1.0, len(fine))) / 2.0
    return np.interp(np.linspace(0.0, 1.0, components + 1), share, fine)


def regular_wave(*, height: float, period: float, wave_from: float, depth: float = 191.0) -> Waves:
    """One long-crested linear wave that does not change.

    Its crest passes the origin at time 0.

    Raises InputError: a height, period or depth that is no positive number, or a wave that breaks.

    Parameters
    ----------
    height
        Crest to trough [m].
    period
        [s].
    wave_from
        Where it comes from, clockwise from true north [deg].
    depth
        Of the water [m].

    Source: Miche (1944): a wave breaks above H = 0.142 L tanh(k depth).
    """
    given = (("height", height, "m"), ("period", period, "s"), ("depth", depth, "m"))
    for name, value, unit in given:
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(
                f"regular_wave: {name} = {value:g} {unit} is not a positive, finite number."
            )
    omega = np.array([2.0 * math.pi / period])
    k = wavenumber(omega, depth=depth)
    highest = 0.142 * 2.0 * math.pi / k[0] * math.tanh(k[0] * depth)
    if height > highest:
        raise InputError(
            f"regular_wave: height = {height:g} m with period = {period:g} s breaks above "
            f"{highest:.2g} m in {depth:g} m of water. Check that period is in s, not in Hz."
        )
    origin = np.array(fold_degrees(wave_from, what="regular_wave: wave_from"))
    return Waves(
        amplitude=np.array([height / 2.0]),
        angular_frequency=omega,
        wavenumber=k,
        phase=np.zeros(1),
        direction=-towards(np.ones(1), origin[None]),
        depth=depth,
    )


def bin_energy(sea: SeaState, edges: Float[np.ndarray, " edge"]) -> Float[np.ndarray, " bin"]:
    """Variance of each bin, scaled to Hs^2 / 16 in all [m2]."""
    fine = np.linspace(edges[:-1], edges[1:], 33)
    energy = np.trapezoid(spectrum(sea, fine.ravel()).reshape(fine.shape), fine, axis=0)
    total = energy.sum()
    return energy * (sea.hs**2 / 16.0 / total) if total > 0.0 else energy


def surface_elevation(waves: Waves, position: N2, time: Float[np.ndarray, "*#n"]) -> PerN:
    """Height of the water's surface above still water [m].

    ``waves``: the sea.
    ``position``: east, north [m].
    ``time``: broadcast against the positions: ``time[:, None]`` gives all points at all times [s].
    """
    return np.asarray(np.cos(_angle(waves, position, time)) @ waves.amplitude)


def water_motion(
    waves: Waves, position: N3, time: Float[np.ndarray, "*#n"]
) -> tuple[Float[np.ndarray, "*n 3"], Float[np.ndarray, "*n 3"]]:
    """Velocity and local acceleration of the water, from the waves alone.

    Wheeler's stretching carries the linear motion up to the moving surface; above it both are
    zero. The acceleration is that at a fixed place. Left out: second-order waves and the
    convective acceleration.

    ``waves``: the sea.
    ``position``: east, north, up from still water [m].
    ``time``: broadcast against the positions [s].

    Returns the velocity [m/s] and the acceleration [m/s2].

    Source: Airy (1845), finite depth; Wheeler (1970).
    """
    angle = _angle(waves, position[..., :2], time)
    cosine, sine = np.cos(angle), np.sin(angle)
    elevation = np.asarray(cosine @ waves.amplitude)
    wet = position[..., 2] <= elevation
    # Points above the surface are zeroed below; the clip keeps their exponentials finite.
    stretched = (position[..., 2] - elevation) * waves.depth / (waves.depth + elevation)
    height = np.asarray(np.clip(stretched, -waves.depth, 0.0))
    along, up = _decay(waves.wavenumber, height, waves.depth)
    omega = waves.angular_frequency
    speed = waves.amplitude * waves.intrinsic_frequency
    velocity = _orient(waves, speed * along * cosine, speed * up * sine)
    acceleration = _orient(waves, speed * omega * along * sine, -speed * omega * up * cosine)
    return velocity * wet[..., None], acceleration * wet[..., None]


def _angle(waves: Waves, position: N2, time: Float[np.ndarray, "*#n"]) -> NWave:
    vector = waves.wavenumber[:, None] * waves.direction
    return position @ vector.T - time[..., None] * waves.angular_frequency + waves.phase


def pressure_head(waves: Waves, position: N3, time: Float[np.ndarray, "*#n"]) -> PerN:
    """Wave pressure in the water, as metres of water [m].

    Below still water as in linear theory, above it as at still water; arguments as in
    ``water_motion``.

    Source: Airy (1845), finite depth.
    """
    k, depth = waves.wavenumber, waves.depth
    height = np.clip(position[..., 2], -depth, 0.0)[..., None]
    bounce = np.exp(-2.0 * k * (height + depth))
    # cosh k(z+h) / cosh kh, in exponentials that decay: cosh itself overflows in deep water.
    share = np.exp(k * height) * (1.0 + bounce) / (1.0 + np.exp(-2.0 * k * depth))
    cosine = np.cos(_angle(waves, position[..., :2], time))
    return np.asarray((share * cosine) @ waves.amplitude)


def _decay(k: Float[np.ndarray, " wave"], z: PerN, depth: float) -> tuple[NWave, NWave]:
    """Decay of velocities: cosh k(z+h) / sinh kh and sinh k(z+h) / sinh kh, z in [-h, 0] [-].

    Written with decaying exponentials: cosh itself overflows in deep water.
    """
    fall = np.exp(k * z[..., None])
    bounce = np.exp(-2.0 * k * (z[..., None] + depth))
    floor = -np.expm1(-2.0 * k * depth)
    return fall * (1.0 + bounce) / floor, fall * (1.0 - bounce) / floor


def _orient(waves: Waves, along: NWave, up: NWave) -> Float[np.ndarray, "*n 3"]:
    return np.concatenate([along @ waves.direction, up.sum(-1, keepdims=True)], axis=-1)


def wave_velocity_variance(
    sea: SeaState, z: Float[np.ndarray, " n"], *, depth: float = 191.0
) -> Float[np.ndarray, "n 2"]:
    """How strongly the waves stir the water at a height, by the whole spectrum.

    Linear and unstretched: heights above still water count as 0, those below the bottom as the
    bottom. Waves shorter than a tenth of the peak's period are left out.

    ``sea``: without waves everything is 0.
    ``z``: up from still water [m].
    ``depth``: of the water [m].

    Returns the variance of the velocity along the waves and of the vertical velocity [m2/s2].
    """
    if sea.hs == 0.0:
        return np.zeros((z.size, 2))
    omega = 2.0 * math.pi / sea.peak_period * np.geomspace(0.4, 10.0, 256)
    along, up = _decay(wavenumber(omega, depth=depth), np.clip(z, -depth, 0.0), depth)
    density = omega**2 * spectrum(sea, omega)
    moments = [np.trapezoid(density * decay**2, omega, axis=-1) for decay in (along, up)]
    return np.stack(moments, axis=-1)
