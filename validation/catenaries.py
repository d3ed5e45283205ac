"""Mooring lines against the line cases of two other programs."""

import math
from collections.abc import Iterator

from seacage.conventions import GRAVITY, WATER_DENSITY
from seacage.dynamics import catenary
from validation._row import Kind, Row, Section

MOORPY = (
    (400.0, 200.0, 500.0, 7.51e12, 800.0, 5.0, 0.0, 0.0, -96643.43501616362, -237751.75997440016),
    (400.0, 200.0, 500.0, 7.51e12, 800.0, 0.0, 96643.42815934008, 0.0, -96643.42815934008,
     -237751.75535996316),
    (400.0, 200.0, 500.0, 7.51e12, 800.0, 0.1, 80418.60434855078, 0.0, -96643.42877136687,
     -237751.77577183915),
    (400.0, 200.0, 500.0, 7.51e12, 200.0, None, 43694.580989249596, -22365.599350216216,
     -43694.580989249596, -77634.40064978378),
    (89.9, 59.2, 130.0, 7.51e8, 881.05, None, 31373.229006023103, -26650.341270116318,
     -31373.229006023103, -87886.15872988368),
)  # fmt: skip
"""Spans, length [m], EA [N], weight [N/m], friction of the sea bed (None: no sea bed), then the
forces on A and on B, horizontal and vertical [N]."""

CHAINS = (
    ("WD0050", 0.252, 390.0, 1.674e9, 400.0, 50.0, 410.0, 991.6, 826.2),
    ("WD0200", 0.252, 390.0, 1.674e9, 700.0, 200.0, 760.0, 2065.4, 1402.2),
)
"""Diameter [m], mass [kg/m], EA [N], span, depth, length [m], tension at top and anchor [kN]."""


def _moorpy() -> Iterator[Row]:
    for number, (x, z, length, stiffness, weight, friction, *forces) in enumerate(MOORPY):
        found = catenary(x, z, length, stiffness, weight, seabed_friction=friction)
        flat = [*found[0], *found[1]]
        top = math.hypot(*forces[2:])
        worst = max(abs(a - b) for a, b in zip(flat, forces, strict=True)) / top
        bed = "no sea bed" if friction is None else f"sea bed with friction {friction:g}"
        line = f"Line {number}, {length:g} m across {x:g} m and up {z:g} m, {bed}"
        yield Row(
            what=f"{line}: tension at the upper end",
            unit="kN",
            reference=top / 1e3,
            ours=math.hypot(*found[1]) / 1e3,
            kind=Kind.OTHER_PROGRAM,
            source="MoorPy's own catenary tests",
            tolerance=1e-6 * top / 1e3,
            reason="1e-6: of one force it prints three values that differ by 7e-8",
        )
        yield Row(
            what=f"{line}: largest difference of the four end forces, over that tension",
            unit="-",
            reference=0.0,
            ours=worst,
            kind=Kind.OTHER_PROGRAM,
            source="MoorPy's own catenary tests",
            tolerance=1e-6,
            reason="as above",
        )


def _moordyn() -> Iterator[Row]:
    for name, diameter, mass, stiffness, span, depth, length, top, anchor in CHAINS:
        weight = (mass - WATER_DENSITY * math.pi / 4.0 * diameter**2) * GRAVITY
        ends = catenary(span, depth, length, stiffness, weight, seabed_friction=0.0)
        for end, reference, force in (("top", top, ends[1]), ("anchor", anchor, ends[0])):
            yield Row(
                what=f"Chain {name}, {length:g} m across {span:g} m in {depth:g} m of water: "
                f"tension at the {end}",
                unit="kN",
                reference=reference,
                ours=math.hypot(*force) / 1e3,
                kind=Kind.OTHER_PROGRAM,
                source="MoorDyn's static tests",
                tolerance=0.10 * reference,
                reason="10 %, that suite's own tolerance for lines of few segments",
            )


SECTIONS = (
    Section(
        title="Mooring lines at rest",
        about="The elastic catenary, `seacage.dynamics.catenary`.",
        rows=lambda: [*_moorpy(), *_moordyn()],
    ),
)
