"""The screen laws against tables computed elsewhere from the published formulas."""

import csv
from collections.abc import Iterator

import numpy as np

from seacage.dynamics import aarsnes, kristiansen_faltinsen, loland
from validation._row import Kind, Row, Section
from validation._shared import ABSENT, shared_file

REYNOLDS = 1500.0
"""Of the twine, at which the table gives Kristiansen and Faltinsen's law [-]."""

TYPED = (
    (0.13, 0.0, 0.13914, 0.0, 0.14270, 0.0, 0.15344, 0.0),
    (0.20, 45.0, 0.19556, 0.05320, 0.21576, 0.06792, 0.15201, 0.05431),
    (0.21, 0.0, 0.28219, 0.0, 0.31252, 0.0, 0.28774, 0.0),
    (0.21, 30.0, 0.24974, 0.04947, 0.27601, 0.06463, 0.22427, 0.05523),
    (0.21, 60.0, 0.16110, 0.04947, 0.17626, 0.06463, 0.10071, 0.04519),
    (0.317, 45.0, 0.45635, 0.14669, 0.44047, 0.15921, 0.30907, 0.10654),
    (0.347, 85.0, 0.10363, 0.03361, 0.09736, 0.03231, 0.03378, 0.01733),
)
"""Solidity, angle between normal and flow [deg], then drag and lift of Aarsnes, Løland and
Kristiansen & Faltinsen."""

LAWS = ("Aarsnes (1990)", "Løland (1991)", "Kristiansen & Faltinsen (2012)")
LAST_DIGIT = 0.51e-5


def coefficients(solidity: float, degrees: float) -> list[float]:
    """Drag and lift of the three laws, in the table's order [-]."""
    cosine = float(np.cos(np.deg2rad(degrees)))
    laws = (
        aarsnes(solidity, cosine),
        loland(solidity, cosine),
        kristiansen_faltinsen(solidity, cosine, REYNOLDS),
    )
    return [float(value) for law in laws for value in law]


def _rows() -> Iterator[Row]:
    typed = np.array(TYPED)
    for law, name in enumerate(LAWS):
        for offset, coefficient in enumerate(("drag", "lift")):
            yield _worst(
                name, coefficient, typed, 2 * law + offset, f"the {len(TYPED)} pairs typed here"
            )
    whole = _whole_table()
    for law, name in enumerate(LAWS):
        for offset, coefficient in enumerate(("drag", "lift")):
            yield _worst(name, coefficient, whole, 2 * law + offset, "the shared table's 42 pairs")


def _worst(law: str, coefficient: str, rows: np.ndarray | None, column: int, where: str) -> Row:
    found = None
    if rows is not None:
        ours = np.array([coefficients(*row[:2])[column] for row in rows])
        found = float(np.abs(ours - rows[:, 2 + column]).max())
    return Row(
        what=f"{law}, {coefficient}: largest difference over {where} of solidity and angle",
        unit="-",
        reference=0.0,
        ours=found,
        kind=Kind.PUBLISHED_MODEL,
        source="the published formula, evaluated apart from this code to five decimals",
        tolerance=LAST_DIGIT,
        reason="half of the last digit printed",
        note="" if rows is not None else ABSENT,
    )


def _whole_table() -> np.ndarray | None:
    path = shared_file("reference/screen_models.csv")
    if path is None:
        return None
    with path.open(encoding="utf-8") as file:
        return np.array([[float(value) for value in row.values()] for row in csv.DictReader(file)])


SECTIONS = (
    Section(
        title="Screen laws",
        about="Drag and lift of a net panel by solidity and angle to the flow.",
        rows=_rows,
    ),
)
