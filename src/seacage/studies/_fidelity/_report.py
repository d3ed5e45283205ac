"""The fidelity study's page: its figures, for the template ``fidelity.html``."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.figures import fouling_figure, gain_figure, left_figure, sector_figure
from seacage.studies._fidelity._claims import THOUSANDTH
from seacage.studies._fidelity._fouling import FoulingGap
from seacage.studies._fidelity._gap import SECTORS, SensorGap
from seacage.studies._fidelity._null_case import Gains, NullCase
from seacage.studies._fidelity._rescaling import LEAST_LEFT, Rescaling

ORIGIN = Origin.VIRTUAL_FIELD  # of every truth and every reading here
_QUANTITIES = {"m": "rise", "kN": "tension"}


def page_values(
    gaps: Sequence[SensorGap], rescalings: Sequence[Rescaling], null: NullCase, fouling: FoulingGap
) -> dict[str, object]:
    """Figures and names of the page besides the scores."""
    titles = [f"{gap.sensor}: {_QUANTITIES[gap.unit]} [{gap.unit}]" for gap in gaps]
    by_sector = {
        name: np.array([_by_sector(gap, name) for gap in gaps])
        for name in ("truth", "low", "bias", "mae", "windows")
    }
    names = [*(one.sensor for one in null.null.sensors), "All together"]
    figures = {
        "sectors": sector_figure(
            titles, SECTORS, by_sector["truth"], by_sector["low"], origin=ORIGIN
        ),
        "left": left_figure(
            [one.sensor for one in rescalings],
            np.array([one.left for one in rescalings]),
            least=LEAST_LEFT,
            origin=ORIGIN,
        ),
        "gains": gain_figure(names, _shares(null.null), _shares(null.real), origin=ORIGIN),
        "fouling": fouling_figure(
            titles,
            fouling.growth,
            fouling.speed,
            fouling.gap,
            met_growth=np.array([met.growth for met in fouling.met]),
            met_gap=np.stack([met.gap for met in fouling.met]),
            origin=ORIGIN,
        ),
    }
    return {
        "sectors": list(SECTORS),
        "by_sector": by_sector,
        "growths": [f"{growth:g}" for growth in fouling.growth],
        "pictures": figures,
        "thousandth": THOUSANDTH,
        "origin": ORIGIN,
    }


def _by_sector(gap: SensorGap, name: str) -> list[float]:
    """One number of each sector; NaN where no current went there."""
    known = {one.sector: float(getattr(one, name)) for one in gap.sectors}
    return [known.get(sector, np.nan) for sector in SECTORS]


def _shares(gains: Gains) -> Float[np.ndarray, "row 3"]:
    rows = [*(one.share for one in gains.sensors), gains.together]
    return np.array([(row.mean, row.low, row.high) for row in rows])
