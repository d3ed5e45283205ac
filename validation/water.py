"""Waves against a measured force, closed forms and the spectra they are drawn from."""

import math
from collections.abc import Iterator

import numpy as np

from seacage.conventions import GRAVITY
from seacage.ocean import SeaState, Waves, sample_waves, spectrum, water_motion, wavenumber
from validation._row import Kind, Row, Section

FRESH_WATER = 1000.0  # kg/m3
HEIGHT, PERIOD, DEPTH, DIAMETER = 0.0704, 1.22, 0.505, 0.25  # m, s, m, m
CYLINDER = "Cylinder of 0.25 m in waves of 0.0704 m and 1.22 s in 0.505 m of water"
TANK = "wave tank; REEF3D tutorial 11_14 (commit 2f8142d), its force record reduced"


def inline_force(*, to_surface: bool) -> float:
    """Amplitude of the inertia force on the cylinder, Cm = 2 [N].

    Integrated to still water, or with stretched kinematics to the moving surface.
    """
    omega = np.array([2.0 * math.pi / PERIOD])
    waves = Waves(
        amplitude=np.array([HEIGHT / 2.0]),
        angular_frequency=omega,
        wavenumber=wavenumber(omega, depth=DEPTH),
        phase=np.zeros(1),
        direction=np.array([[1.0, 0.0]]),
        depth=DEPTH,
    )
    area = math.pi / 4.0 * DIAMETER**2
    forces = []
    for time in np.linspace(0.0, PERIOD, 100, endpoint=False):
        surface = HEIGHT / 2.0 * math.cos(omega[0] * time)
        z = np.linspace(-DEPTH, surface if to_surface else 0.0, 201)
        # the linear motion at z, wherever stretching has moved it
        at = z if to_surface else z * (DEPTH + surface) / DEPTH + surface
        place = np.stack([np.zeros_like(z), np.zeros_like(z), at], axis=-1)
        _, acceleration = water_motion(waves, place, np.full_like(z, time))
        forces.append(np.trapezoid(FRESH_WATER * 2.0 * area * acceleration[:, 0], z))
    return (max(forces) - min(forces)) / 2.0


def _cylinder() -> Iterator[Row]:
    yield Row(
        what=f"{CYLINDER}: amplitude of the force along the waves",
        unit="N",
        reference=(29.60 - 0.42, 29.60 + 0.42),
        ours=inline_force(to_surface=True),
        kind=Kind.MEASURED,
        source=TANK,
        tolerance=0.05 * 29.60,
        reason="5 %: Cm = 2 holds for a slender cylinder, this one has kR = 0.37",
        note="Airy's motion with Wheeler's stretching, inertia force only, fresh water.",
    )
    yield Row(
        what=f"{CYLINDER}: amplitude of Morison's inertia force, Airy's motion to still water",
        unit="N",
        reference=30.7,
        ours=inline_force(to_surface=False),
        kind=Kind.CLOSED_FORM,
        source="linear Morison, as reduced with that record",
        tolerance=0.05,
        reason="half of the last digit printed",
    )


def _linear_waves() -> Iterator[Row]:
    for depth, period, asymptote, name in (
        (191.0, 8.0, GRAVITY * 8.0**2 / (2.0 * math.pi), "g T² / 2π in deep water"),
        (5.0, 60.0, 60.0 * math.sqrt(GRAVITY * 5.0), "T √(g h) in shallow water"),
    ):
        k = wavenumber(np.array([2.0 * math.pi / period]), depth=depth)[0]
        yield Row(
            what=f"Length of a wave of {period:g} s in {depth:g} m of water",
            unit="m",
            reference=asymptote,
            ours=2.0 * math.pi / float(k),
            kind=Kind.CLOSED_FORM,
            source=f"Airy (1845): {name}",
            tolerance=0.005 * asymptote,
            reason="0.5 %: what the depth still changes",
        )


def _irregular() -> Iterator[Row]:
    for hs, tp in ((1.0, 5.0), (3.0, 8.66), (2.0, 11.0)):
        sea = SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp)
        omega = np.geomspace(0.02, 40.0, 20001)
        area = 4.0 * math.sqrt(np.trapezoid(spectrum(sea, omega), omega))
        what = f"Sea of Hs {hs:g} m, Tp {tp:g} s"
        yield Row(
            what=f"{what}: 4 × root of the spectrum's area",
            unit="m",
            reference=hs,
            ours=area,
            kind=Kind.CLOSED_FORM,
            source="DNV-RP-C205 (2010), 3.5.5: the area is Hs²/16",
            tolerance=0.01 * hs,
            reason="1 %: the published normalising factor is a fit",
        )
        waves = sample_waves(sea, seed=1)
        yield Row(
            what=f"{what}: 4 × standard deviation of the 30 waves drawn from it",
            unit="m",
            reference=hs,
            ours=4.0 * math.sqrt(float(np.sum(waves.amplitude**2)) / 2.0),
            kind=Kind.CLOSED_FORM,
            source="DNV-RP-C205 (2010): variance Hs²/16",
            tolerance=1e-9 * hs,
            reason="each draw is scaled to it",
        )


SECTIONS = (
    Section(
        title="Waves",
        about="Dispersion, the water's motion, the force of inertia and the sea's energy.",
        rows=lambda: [*_cylinder(), *_linear_waves(), *_irregular()],
    ),
)
