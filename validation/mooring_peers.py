"""The mooring of the reference cage against MoorPy and MoorDyn."""

from collections.abc import Iterator
from functools import lru_cache

from seacage.cage import Cage
from seacage.dynamics import settle
from seacage.ocean import SeaState
from validation._driven_line import driven_line
from validation._peers import driven_by_moordyn, has, rest_by_moorpy
from validation._row import Kind, Row, Section

ACE = Cage.named("ace")

MOORPY = "MoorPy 1.3.0"
AT_REST = {
    "frame line": 23_207.8,
    "anchor line": 45_935.1,
    "level pull on an anchor": 43_503.7,
    "uplift of an anchor": 6_146.6,
}
"""What it finds with elastic catenaries [N]."""

MOORDYN = "MoorDyn 2.7.2"
AMPLITUDE = 2.0
DRIVEN = {
    5.0: (65_575.0, 27_257.0, 46_528.0),
    8.0: (65_914.0, 27_475.0, 46_555.0),
    10.0: (66_049.0, 27_669.0, 46_552.0),
    15.0: (66_082.0, 28_000.0, 46_554.0),
}
"""Largest, least and mean tension by period [s], of rope in 54 segments and chain in 12 [N]."""


def _source(program: str, *, here: bool) -> str:
    name, _, _ = program.partition(" ")
    return f"{name}, run beside ours" if here else f"{program}, its answers typed"


def _at_rest() -> Iterator[Row]:
    here = has("moorpy")
    references = rest_by_moorpy(ACE) if here else AT_REST
    still = settle(ACE, SeaState(current_speed=0.0, current_to=0.0))
    kinds = dict(zip(still.line_names, still.line_tension.tolist(), strict=True))
    load = still.anchor_load[0]
    ours = {
        "frame line": kinds["frame-1"],
        "anchor line": kinds["anchor-1"],
        "level pull on an anchor": float((load[:2] ** 2).sum() ** 0.5),
        "uplift of an anchor": float(load[2]),
    }
    for what, reference in references.items():
        yield Row(
            what=f"Whole mooring of ace in still water: {what}",
            unit="kN",
            reference=reference / 1e3,
            ours=ours[what] / 1e3,
            kind=Kind.OTHER_PROGRAM,
            source=_source(MOORPY, here=here),
            tolerance=0.01 * reference / 1e3,
            reason="1 %: 12 and 4 straight segments for elastic catenaries",
        )


@lru_cache(maxsize=4)
def _driven_by_moordyn(period: float) -> tuple[float, float, float]:
    return driven_by_moordyn(ACE, amplitude=AMPLITUDE, period=period)


def _driven() -> Iterator[Row]:
    here = has("moordyn")
    for period, typed in DRIVEN.items():
        references = _driven_by_moordyn(period) if here else typed
        ours = driven_line(ACE, amplitude=AMPLITUDE, period=period)
        for which, share, reference, found in zip(
            ("largest", "least", "mean"), (0.02, 0.02, 0.01), references, ours, strict=True
        ):
            yield Row(
                what=f"Anchor line of ace, its corner driven by ± {AMPLITUDE:g} m at {period:g} s: "
                f"{which} tension",
                unit="kN",
                reference=reference / 1e3,
                ours=found / 1e3,
                kind=Kind.OTHER_PROGRAM,
                source=_source(MOORDYN, here=here),
                tolerance=share * reference / 1e3,
                reason=f"{100.0 * share:g} %: 16 segments for its 66, steps of 2 ms",
            )


SECTIONS = (
    Section(
        title="The mooring by other programs",
        about="Still water by MoorPy, and an anchor line whose corner is driven level in its plane "
        "by MoorDyn. Where these programs are installed (`pip install moorpy moordyn`) they are "
        "run beside ours.",
        rows=lambda: [*_at_rest(), *_driven()],
    ),
)
