"""Time stepping against closed forms: pendulum, string, chain, float, fall, orbit, energy."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import WATER_DENSITY
from seacage.dynamics import settle
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._motion import NetLaw, Water, moving_cylinder_force, moving_net_load
from seacage.dynamics._physics._screens import MOVING_LAWS
from seacage.ocean import SeaState, Waves, wavenumber
from validation._bare import afloat, chain, energy, marched, period
from validation._row import Kind, Row, Section

STEP = "0.5 %: steps of 2 ms, single precision"


def _row(what: str, unit: str, reference: float, ours: float, source: str, reason: str) -> Row:
    return Row(
        what=what,
        unit=unit,
        reference=reference,
        ours=ours,
        kind=Kind.CLOSED_FORM,
        source=source,
        tolerance=0.005 * reference,
        reason=reason,
    )


def _pendulum() -> Iterator[Row]:
    length, mass, weight = 12.0, 300.0, 1800.0
    for degrees in (5.0, 40.0):
        angle = math.radians(degrees)
        start = np.array([[0.0, 0.0, 0.0], [math.sin(angle), 0.0, -math.cos(angle)]]) * length
        bob = chain(
            start * np.array([0.0, 1.0, 1.0]),
            held=[0],
            mass=np.array([1.0, mass]),
            weight=np.array([0.0, -weight]),
            axial_stiffness=2e6,
            length=length,
        )
        time, position, _ = marched(bob, start, duration=60.0)
        small = 2.0 * math.pi * math.sqrt(mass * length / weight)
        large = small * (1.0 + angle**2 / 16.0 + 11.0 * angle**4 / 3072.0)
        yield _row(
            f"Pendulum of 12 m swinging by {degrees:g}° in water, without drag: period",
            "s",
            large,
            period(time, position[:, 1, 0]),
            "2π √(m L/W), m with added mass and W submerged, and its series in the angle",
            STEP,
        )


def _string() -> Iterator[Row]:
    span, tension, mass, links = 50.0, 10e3, 4.0, 40
    stiffness = 1e5
    natural = span / (1.0 + tension / stiffness)
    x = np.linspace(0.0, span, links + 1)
    straight = np.stack([x, np.zeros_like(x), np.full_like(x, -20.0)], axis=1)
    lumped = np.full(links + 1, mass * span / links)
    for mode in (1, 2):
        start = straight.copy()
        start[:, 1] += 0.05 * np.sin(mode * math.pi * x / span)
        line = chain(
            straight, held=[0, links], mass=lumped, axial_stiffness=stiffness, length=natural
        )
        time, position, _ = marched(line, start, duration=30.0, time_step=0.001)
        yield _row(
            f"String of 50 m under 10 kN, plucked in its mode {mode}: frequency",
            "Hz",
            mode / (2.0 * span) * math.sqrt(tension / mass),
            1.0 / period(time, position[:, links // (2 * mode), 1]),
            "n/2L √(T/m)",
            "0.5 %: 40 links lower it by 0.03 % in mode 1 and 0.1 % in mode 2",
        )


def _hanging_chain() -> Iterator[Row]:
    length, mass, weight, links, stiffness = 20.0, 30.0, 180.0, 40, 5e5
    z = -np.linspace(0.0, length, links + 1)
    below = weight * length * (1.0 - (np.arange(links) + 0.5) / links)
    z[1:] -= np.cumsum(below * length / links / stiffness)  # stretched by what hangs below
    straight = np.stack([np.zeros_like(z), np.zeros_like(z), z], axis=1)
    share = np.full(links + 1, length / links)
    share[[0, -1]] /= 2.0
    line = chain(
        straight,
        held=[0],
        mass=mass * share,
        weight=-weight * share,
        axial_stiffness=stiffness,
        length=length,
    )
    root = 2.404825557695773  # the first of J0
    start = straight.copy()
    start[:, 0] += 0.2 * _bessel(root * np.sqrt(1.0 - z / z[-1]))
    time, position, _ = marched(line, start, duration=60.0, time_step=0.001)
    yield _row(
        "Chain of 20 m hanging free, let go in its first mode: period",
        "s",
        4.0 * math.pi / root * math.sqrt(mass * length / weight),
        period(time, position[:, -1, 0]),
        "4π/j √(m L/w), j the first root of J0",
        "0.5 %: 40 links, and the stretch by its own weight, 0.4 % of its length",
    )


def _bessel(x: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    from scipy.special import j0

    return np.asarray(j0(x))


def _float() -> Iterator[Row]:
    mass, stiffness = 5000.0, 20e3
    time, position, _ = marched(
        afloat(mass, stiffness, draft=0.6), np.array([[0.0, 0.0, 0.2]]), duration=60.0
    )
    yield _row(
        "Float pushed up by 0.2 m, without drag: period of its heave",
        "s",
        2.0 * math.pi * math.sqrt(mass / stiffness),
        period(time, position[:, 0, 2]),
        "2π √(m/k), k = ρ g × waterplane",
        STEP,
    )


def _fall() -> Iterator[Row]:
    weight, width, span = 200.0, 1.2 * 0.05, 10.0
    start = np.array([[0.0, 0.0, -1.0], [span, 0.0, -1.0]])
    rod = chain(
        start,
        held=(),
        mass=np.full(2, 150.0),
        weight=-weight * span / 2.0,
        axial_stiffness=1e6,
        length=span,
        drag_width=width,
    )
    _, position, _ = marched(rod, start, duration=30.0)
    yield _row(
        "Rod of 50 mm and 200 N/m sinking level in still water: speed in the end",
        "m/s",
        math.sqrt(2.0 * weight / (WATER_DENSITY * width)),
        float(position[-11, 0, 2] - position[-1, 0, 2]),
        "√(2 w/ρ C_D D)",
        "0.5 %: steps of 2 ms",
    )


def _orbit() -> Iterator[Row]:
    amplitude, wave_period, depth = 1.0, 8.0, 191.0
    omega = np.array([2.0 * math.pi / wave_period])
    k = wavenumber(omega, depth=depth)
    wave = Waves(
        amplitude=np.array([amplitude]),
        angular_frequency=omega,
        wavenumber=k,
        phase=np.array([math.pi / 2.0]),
        direction=np.array([[0.6, 0.8]]),
        depth=depth,
    )
    for z in (-5.0, -15.0):
        start = np.array([[0.0, 0.0, z]])
        particle = chain(start, held=(), mass=np.array([100.0]))
        # the water pushes it as it pushes the water whose place it takes
        particle = replace(particle, water_mass=np.array([100.0]))
        _, position, _ = marched(particle, start, duration=wave_period, waves=wave)
        heave = position[:, 0, 2]
        yield Row(
            what=f"Neutral particle {-z:g} m below waves of 2 m and 8 s: height of its orbit",
            unit="m",
            reference=2.0 * amplitude * math.exp(float(k[0]) * z),
            ours=float(heave.max() - heave.min()),
            kind=Kind.CLOSED_FORM,
            source="Airy's orbit in deep water, H exp(k z)",
            tolerance=0.03 * 2.0 * amplitude * math.exp(float(k[0]) * z),
            reason="3 %: the orbit's own height shifts k z by up to k a = 6 %, half of it mean",
        )


def _power() -> Iterator[Row]:
    """The water's power on a cage that moves through still water, over its drag's scale."""
    assembly = Assembly.of(Cage.named("ace"))
    random = np.random.default_rng(3)
    shape = (40, len(assembly.position), 3)
    position = assembly.position + random.normal(0.0, 1.0, shape)
    velocity = random.normal(0.0, 1.0, shape) * 10.0 ** random.uniform(-3.0, 0.5, (40, 1, 1))
    nothing = np.zeros(shape)
    still = Water(
        velocity=nothing, acceleration=nothing, elevation=np.zeros(shape[:2]), current=nothing
    )
    for name in MOVING_LAWS:
        law = NetLaw(name=name, wake=np.ones((40, len(assembly.panels.area))))
        load = moving_net_load(assembly.panels, law, still, position, velocity)
        own = np.einsum("npcx,pc->npx", velocity[:, assembly.panels.corners], assembly.panels.share)
        power = np.sum(load * own, axis=-1)
        scale = np.linalg.norm(load, axis=-1) * np.linalg.norm(own, axis=-1)
        yield _dissipation(
            f"each panel of a net moving at random in still water, {name}", power, scale
        )
    load = moving_cylinder_force(assembly.cylinders, still, position, velocity)
    power = np.sum(load * velocity, axis=(1, 2))
    scale = np.sum(np.linalg.norm(load, axis=-1) * np.linalg.norm(velocity, axis=-1), axis=1)
    yield _dissipation("collar and tube moving at random in still water", power, scale)


def _dissipation(what: str, power: Float[np.ndarray, "*n"], scale: Float[np.ndarray, "*n"]) -> Row:
    return Row(
        what=f"Largest power of the water on {what}, over force × speed",
        unit="-",
        reference=(-math.inf, 0.0),
        ours=float(np.max(power / np.maximum(scale, 1e-300))),
        kind=Kind.CLOSED_FORM,
        source="drag takes energy, lift does no work",
        tolerance=1e-12,
        reason="rounding of doubles",
    )


def _decay() -> Iterator[Row]:
    """The cage bent by a current that stops at once, and its energy while it comes to rest."""
    cage = Cage.named("ace")
    assembly, _ = scale_mass(Assembly.of(cage), 0.002)
    start = assembly.position.copy()
    bent = settle(cage, SeaState(current_speed=0.8, current_to=30.0))
    start[: cage.node_count] = bent.node_position
    _, position, velocity = marched(assembly, start, duration=120.0, law="kristiansen-faltinsen")
    level = energy(assembly, position, velocity)
    yield Row(
        what="Cage let go in still water from its shape at 0.8 m/s: largest gain of energy in "
        "0.1 s, of what it loses in 2 min",
        unit="-",
        reference=(-math.inf, 0.0),
        ours=float(np.diff(level).max() / (level[0] - level[-1])),
        kind=Kind.CLOSED_FORM,
        source="drag and structural damping take energy, nothing gives any",
        tolerance=1e-4,
        reason="1e-4: the velocity of a leapfrog step is half a step old",
    )


SECTIONS = (
    Section(
        title="Swings, strings and energy",
        about="Bare structures, marched by the compiled kernel that simulates the cage.",
        rows=lambda: [
            *_pendulum(),
            *_string(),
            *_hanging_chain(),
            *_float(),
            *_fall(),
            *_orbit(),
            *_power(),
            *_decay(),
        ],
    ),
)
