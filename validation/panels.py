"""Panels of netting against what flume tests found, by all four laws."""

import math
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise

import numpy as np

from validation._panel import PANEL_LAWS
from validation._row import Kind, Row, Section

HALF_MESH, SPEED = 0.029, 0.5
"""Of the panel that is taken for all rows [m, m/s]."""

SOLIDITY = 0.20
"""Where a row depends on it and its source does not say it."""

GROWTH = (0.13, 0.16, 0.19, 0.22, 0.25, 0.28, 0.31)
"""Solidities over which the growth of drag is averaged."""

Law = Callable[[float, float], tuple[float, float]]
"""Drag and lift by solidity and by the cosine between normal and flow."""

NAMES = {
    "aarsnes": "Aarsnes",
    "loland": "Løland",
    "kristiansen-faltinsen": "Kristiansen & Faltinsen",
    "morison": "twine by twine",
}
LAWS: dict[str, Law] = {
    NAMES[name]: partial(law, speed=SPEED, half_mesh=HALF_MESH) for name, law in PANEL_LAWS.items()
}

TRAWL = (
    "The source's nets are knotted polyethylene trawl netting, whose meshes close as it hangs; "
    "our laws are of square knotless mesh."
)
FITTED = (
    "The fit's net is not in the stored text, so only the ratio to its own C_D(0) is compared. "
    "Both fits give more lift, over that drag, than any of our laws at a solidity of 0.20."
)


def _spanned(
    what: str,
    reference: float,
    source: str,
    ours: Callable[[Law], float],
    *,
    kind: Kind = Kind.MEASURED,
    tolerance: float,
    reason: str,
    note: str = "",
    unit: str = "-",
) -> Row:
    """A row whose ensemble is the four laws, each told in the note."""
    found = {name: ours(law) for name, law in LAWS.items()}
    return Row(
        what=what,
        unit=unit,
        reference=reference,
        ours=(min(found.values()), max(found.values())),
        kind=kind,
        source=source,
        tolerance=tolerance,
        reason=reason,
        must_hold=False,
        detail=", ".join(f"{name} {value:.3g}" for name, value in found.items()),
        note=note,
    )


def _growth() -> Iterator[Row]:
    for step, percent in ((0.03, 7.0), (0.1, 30.0)):
        pairs = pairwise(GROWTH) if step == 0.03 else [(s, s + 0.1) for s in (0.13, 0.16, 0.19)]
        several = list(pairs)

        def growth(
            law: Law,
            several: list[tuple[float, float]] = several,
        ) -> float:
            ratios = [law(b, 1.0)[0] / b / (law(a, 1.0)[0] / a) for a, b in several]
            return 100.0 * (float(np.mean(ratios)) - 1.0)

        yield _spanned(
            f"Facing panel: growth of C_D on the twines' area for +{step:g} of solidity",
            percent,
            "netting of eight solidities in a tank (DBpia NODE02394524, abstract)",
            growth,
            unit="%",
            tolerance=0.15 * percent,
            reason="15 %: the abstract gives a mean and not the solidities",
            note="Mean from 0.13 to 0.31. The abstract does not say which area its C_D is on; "
            "on the panel's area all laws grow several times as fast, as the area of twine does.",
        )


def _turned() -> Iterator[Row]:
    for attack in (30.0, 45.0, 60.0):
        sine, cosine = math.sin(math.radians(attack)), math.cos(math.radians(attack))
        for name, part, formula, value in (
            ("C_D", 0, "sin^0.4 α", sine**0.4),
            ("C_L", 1, "sin^1.5 α cos α", sine**1.5 * cosine),
        ):
            yield _spanned(
                f"Panel at {attack:g}° to the flow: {name} over C_D at 90°",
                value,
                f"fit {formula} to trawl netting (Bull. Jpn. Soc. Sci. Fish. 45/10, abstract)",
                lambda law, part=part, sine=sine: law(SOLIDITY, sine)[part] / law(SOLIDITY, 1.0)[0],
                tolerance=0.10 * value,
                reason="10 %: a fit through scatter that is not printed",
                note=TRAWL,
            )
    yield _spanned(
        "Panel along the flow: C_D over that of a facing one",
        0.30,
        "mean of the literature on nylon nets, quoted by Xu et al. (2020)",
        lambda law: law(SOLIDITY, 0.0)[0] / law(SOLIDITY, 1.0)[0],
        tolerance=0.03,
        reason="10 %: said to be approximate",
        note="Twines in each other's lee are sheltered, which no law here counts as such.",
    )


FITS = {
    "Lee et al. (2005)": {30: (0.8836, 0.5009), 45: (0.5351, 0.4773), 60: (0.2365, 0.2905)},
    "Bi et al. (2014)": {30: (0.6066, 0.2334), 45: (0.4816, 0.2469), 60: (0.3329, 0.2334)},
}
FACING = {"Lee et al. (2005)": 1.155, "Bi et al. (2014)": 0.7194}
"""Drag and lift by θ between normal and flow [deg], and drag at θ = 0, as printed fits give it."""


def _fits() -> Iterator[Row]:
    for source, fit in FITS.items():
        for degrees, values in fit.items():
            cosine = math.cos(math.radians(degrees))
            for part, name in enumerate(("C_D", "C_L")):
                value = values[part] / FACING[source]
                yield _spanned(
                    f"Panel turned {degrees:g}° from facing: {name} over C_D(0), {source}",
                    value,
                    f"fit of {source} to flume tests",
                    lambda law, part=part, cosine=cosine: (
                        law(SOLIDITY, cosine)[part] / law(SOLIDITY, 1.0)[0]
                    ),
                    tolerance=0.10 * value,
                    reason="10 %: a fit through scatter that is not printed",
                    note=FITTED,
                )


SECTIONS = (
    Section(
        title="Net panels in a flume",
        about="Published relations of drag and lift, beside the span of our four laws (three "
        "screens and twine by twine). A miss here says how far the laws of square knotless mesh "
        "are from other netting; none was tuned.",
        rows=lambda: [*_growth(), *_turned(), *_fits()],
    ),
)
