"""Geometry, elasticity and floating of the reference cage against closed forms."""

import math
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics import settle
from seacage.dynamics._parts._assembly import Assembly, Bars, Bends
from seacage.dynamics._physics._loads import bar_force, bend_force, float_force
from seacage.ocean import SeaState
from validation._row import Kind, Row, Section

RADIUS, BENDING, JOINTS = 25.0, 2.0 * 1.589e6, 240
"""Of the collar [m], EI of its two pipes [N m2], and the joints that a ring is cut into here."""

POLYGON = 16.0 * RADIUS**2 * math.sin(math.pi / 16.0)
"""Area of the 32-gon that the collar is drawn as [m2]."""


class _Ring:
    """A free elastic ring, and its stiffness against a deformation of its centre line."""

    def __init__(self) -> None:
        turn = np.arange(JOINTS)
        self.angle = 2.0 * math.pi * turn / JOINTS
        zero = np.zeros(JOINTS)
        self.outward = np.stack([np.cos(self.angle), np.sin(self.angle), zero], axis=1)
        self.along = np.stack([-np.sin(self.angle), np.cos(self.angle), zero], axis=1)
        self.circle = RADIUS * self.outward
        chord = 2.0 * RADIUS * math.sin(math.pi / JOINTS)
        self.bends = Bends.ring(turn, BENDING / chord)
        self.hoop = Bars(
            ends=np.stack([turn, np.roll(turn, -1)], axis=1),
            length=np.full(JOINTS, chord),
            stiffness=np.full(JOINTS, 1e5 * BENDING / RADIUS**2),  # as good as inextensible
            pushed=np.ones(JOINTS, dtype=bool),
            damping_ratio=zero,
        )

    def stiffness(
        self, shape: Float[np.ndarray, "joint 3"], other: Float[np.ndarray, "joint 3"]
    ) -> float:
        """Work of one deformation against the force that another calls up [N/m]."""
        step = 1e-4
        answer = (self._force(step * other) - self._force(-step * other)) / (2.0 * step)
        return -float(np.sum(shape * answer))

    def _force(self, moved: Float[np.ndarray, "joint 3"]) -> Float[np.ndarray, "joint 3"]:
        position = (self.circle + moved)[None]
        return (bend_force(self.bends, position) + bar_force(self.hoop, position))[0]

    def in_plane(self, n: int) -> float:
        """Of n waves round the ring, free to slide along itself [N/m]."""
        radial = np.cos(n * self.angle)[:, None] * self.outward
        sliding = np.sin(n * self.angle)[:, None] * self.along
        coupled = self.stiffness(radial, sliding)
        return self.stiffness(radial, radial) - coupled**2 / self.stiffness(sliding, sliding)

    def out_of_plane(self, n: int) -> float:
        """Of n waves round the ring, up and down, free to twist [N/m]."""
        upward = np.cos(n * self.angle)[:, None] * np.array([0.0, 0.0, 1.0])
        return self.stiffness(upward, upward)


def _rings() -> Iterator[Row]:
    ring = _Ring()
    share = BENDING / RADIUS**4 * math.pi * RADIUS
    for n in (2, 3, 4):
        for way, found, formula, classical in (
            ("in its plane", ring.in_plane(n), "(n² − 1)² EI/R⁴", (n**2 - 1) ** 2),
            ("out of its plane", ring.out_of_plane(n), "n² (n² − 1) EI/R⁴", n**2 * (n**2 - 1)),
        ):
            yield Row(
                what=f"Collar as a free ring, {n} waves {way}: generalised stiffness",
                unit="kN/m",
                reference=classical * share / 1e3,
                ours=found / 1e3,
                kind=Kind.CLOSED_FORM,
                source=f"{formula} by metre; Love (1927), without torsion",
                tolerance=0.005 * classical * share / 1e3,
                reason="0.5 %: 240 chords for a circle, and a hoop that gives",
            )


def _floating() -> Iterator[Row]:
    cage = Cage.named("ace")
    parts = Assembly.of(cage)
    width = cage.collar.pipes * cage.collar.pipe_diameter
    density = WATER_DENSITY * GRAVITY
    x = parts.position[:, 0]

    def buoyancy(lift: Float[np.ndarray, " node"]) -> Float[np.ndarray, " node"]:
        position = parts.position + lift[:, None] * np.array([0.0, 0.0, 1.0])
        return float_force(parts.floats, position[None])[0, :, 2]

    heave = np.sum(buoyancy(np.full_like(x, -0.01)) - buoyancy(np.full_like(x, 0.01))) / 0.02
    pitch = np.sum(x * (buoyancy(-1e-4 * x) - buoyancy(1e-4 * x))) / 2e-4
    drowned = np.sum(buoyancy(np.full_like(x, -5.0)))
    for what, unit, reference, ours, source in (
        (
            "heave stiffness",
            "kN/m",
            density * width * 2.0 * math.pi * RADIUS / 1e3,
            heave / 1e3,
            "ρ g × waterplane",
        ),
        (
            "pitch stiffness",
            "MN m/rad",
            density * width * math.pi * RADIUS**3 / 1e6,
            pitch / 1e6,
            "ρ g × second moment of the waterplane",
        ),
        (
            "buoyancy when drowned",
            "kN",
            density * 2.0 * cage.collar.pipe_displaced * 2.0 * math.pi * RADIUS / 1e3,
            drowned / 1e3,
            "ρ g × volume",
        ),
    ):
        yield Row(
            what=f"Collar afloat: {what}",
            unit=unit,
            reference=float(reference),
            ours=float(ours),
            kind=Kind.CLOSED_FORM,
            source=f"Archimedes: {source}",
            tolerance=1e-6 * float(reference),
            reason="the rounding of doubles in a difference",
        )


def _geometry() -> Iterator[Row]:
    cage = Cage.named("ace")
    ends = cage.design_position[cage.bridle_nodes] - cage.corner_position[cage.bridle_corner]
    spans = np.sort(np.linalg.norm(ends, axis=1))
    still = settle(cage, SeaState(current_speed=0.0, current_to=0.0))
    for what, unit, reference, ours, tolerance, source, reason in (
        (
            "Volume of the design shape",
            "m3",
            POLYGON * (15.0 + 16.0 / 3.0),
            float(cage.volume(cage.design_position)),
            1e-6,
            "prism and pyramid over a 32-gon",
            "rounding",
        ),
        (
            "Span of the shortest bridle",
            "m",
            36.0,
            float(spans[0]),
            0.05,
            "its frame",
            "last digit",
        ),
        (
            "Span of the longest bridle",
            "m",
            39.05,
            float(spans[-1]),
            0.005,
            "its frame",
            "last digit",
        ),
        (
            "Largest difference of a bridle's tension at rest from its pretension",
            "kN",
            0.0,
            float(np.abs(still.bridle_tension - cage.bridles.pretension).max()) / 1e3,
            0.25,
            "the cage file",
            "2.5 % of the pretension, which two passes of cutting the bridles leave",
        ),
    ):
        yield Row(
            what=what,
            unit=unit,
            reference=reference,
            ours=ours,
            kind=Kind.CLOSED_FORM,
            source=source,
            tolerance=tolerance,
            reason=reason,
        )


SECTIONS = (
    Section(
        title="Rings, floating, geometry",
        about="Parts of the cage `ace` alone.",
        rows=lambda: [*_rings(), *_floating(), *_geometry()],
    ),
)
