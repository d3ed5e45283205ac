"""The fidelity study as one HTML page that needs nothing beside itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.conventions import Origin
from seacage.figures import Panel, fouling_figure, gain_figure, left_figure, sector_figure
from seacage.studies._claim import Claim
from seacage.studies._fidelity._claims import THOUSANDTH, ends
from seacage.studies._fidelity._fouling import FoulingGap
from seacage.studies._fidelity._gap import SECTORS, SensorGap
from seacage.studies._fidelity._null_case import Gain, Gains, NullCase
from seacage.studies._fidelity._rescaling import LEAST_LEFT, Rescaling, Rescalings
from seacage.studies._interval import Interval
from seacage.studies._page import Html, bar, claims, facts, page, picture, table, tag
from seacage.studies._text import number, percent

ORIGIN = Origin.VIRTUAL_FIELD
"""Of every truth and every reading here."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FidelityReport:
    """What the page is written from.

    Parameters
    ----------
    claims
        With their verdicts.
    gaps, rescalings, null, fouling
        The four parts.
    recipe, provenance
        What was done and with what, as name and value.
    """

    claims: Sequence[Claim]
    gaps: Sequence[SensorGap]
    rescalings: Rescalings
    null: NullCase
    fouling: FoulingGap
    recipe: Mapping[str, str]
    provenance: Mapping[str, str]

    def html(self) -> str:
        """The whole page."""
        return page(
            "The fidelity study with seacage",
            self._header(),
            *self._gaps(),
            *self._rescaling(),
            *self._null(),
            *self._fouling(),
            *self._end(),
        )

    def _header(self) -> Html:
        held = sum(bool(claim.holds) for claim in self.claims)
        return tag(
            "header",
            tag("span", "Virtual field", look="badge"),
            tag("h1", "Two simulators that must differ"),
            tag(
                "p",
                "A twin that learns a virtual field proves little if the field is the low fidelity "
                "in disguise. So the field has other physics and hidden parameters, and this page "
                "measures how far the two are apart, how much of that a simple correction could "
                "mend, and that multifidelity gains nothing where there is nothing to gain. "
                f"{held} of {len(self.claims)} claims hold.",
                look="lead",
            ),
            claims((one.verdict, one.claim, one.finding) for one in self.claims),
        )

    def _gaps(self) -> list[Html]:
        truth, low = (
            np.array([[_of(gap, sector, name) for sector in SECTORS] for gap in self.gaps])
            for name in ("truth", "low")
        )
        figure = sector_figure(_panels(self.gaps), SECTORS, truth, low, origin=ORIGIN)
        return [
            tag("h2", "Low fidelity against the truth"),
            tag(
                "p",
                "The truth is what error-free sensors would read in the virtual field. The low "
                "fidelity answers the water that the buoy reports, as a twin hears it. Depth "
                "sensors count by how far they rise above the drawn cage's shape in still water.",
            ),
            self._gap_table(),
            picture(
                figure,
                caption="Mean response of the truth and of the low fidelity, by where the current "
                "goes at the buoy (virtual field). A direction without bars had no current.",
                alternative="Truth and low fidelity by direction of the current",
                look="wide",
            ),
            self._sector_table("bias", "Low fidelity less truth"),
            self._sector_table("mae", "Mean absolute error of the low fidelity"),
        ]

    def _gap_table(self) -> Html:
        head = ("Sensor", "Windows", "Truth", "Low", "Bias [95 % interval]", "MAE", "Origin")
        rows = [
            (
                f"{gap.sensor} [{gap.unit}]",
                str(gap.windows),
                number(gap.truth),
                tag("span", number(gap.low), look="low"),
                f"{number(gap.bias.mean)} [{ends(gap.bias)}]",
                number(gap.mae),
                tag("small", ORIGIN),
            )
            for gap in self.gaps
        ]
        return table(
            head,
            rows,
            caption="Means over all surveyed windows: rise of the depth sensors, tension at the "
            "shackles. Bias is low fidelity less truth, below zero where it underestimates; its "
            "interval is by a block bootstrap with blocks of a day. MAE: mean absolute error of "
            "10-minute means.",
        )

    def _sector_table(self, name: str, what: str) -> Html:
        rows = [
            (
                f"{gap.sensor} [{gap.unit}]",
                *(
                    "–" if np.isnan(value := _of(gap, sector, name)) else number(value)
                    for sector in SECTORS
                ),
            )
            for gap in self.gaps
        ]
        counts = [_of(self.gaps[0], sector, "windows") for sector in SECTORS]
        windows = ("Windows", *("–" if np.isnan(count) else f"{count:.0f}" for count in counts))
        return table(
            ("Current goes", *SECTORS),
            [*rows, windows],
            caption=f"{what}, by where the current goes (virtual field).",
        )

    def _rescaling(self) -> list[Html]:
        sensors = self.rescalings.sensors
        off = self.rescalings.emulation_mae
        return [
            tag("h2", "What the best rescaling and rotation leaves"),
            tag(
                "p",
                "Each sensor gets a correction of its own: the current's speed times a factor, the "
                "current turned, the answer times a gain plus an offset, all four with the least "
                "mean absolute error against the truth itself on every other day. What is left is "
                "measured on the days between. If this mended the low fidelity, a twin would only "
                "have to find four numbers.",
            ),
            picture(
                left_figure(
                    [one.sensor for one in sensors],
                    np.array([one.left for one in sensors]),
                    least=LEAST_LEFT,
                    origin=ORIGIN,
                ),
                caption="Mean absolute error on days not fitted to, over that of the low fidelity "
                "as it is (virtual field).",
                alternative="Share of the error that is left, by sensor",
                look="narrow",
            ),
            table(
                (
                    "Sensor",
                    "Speed ×",
                    "Turn [°]",
                    "Gain ×",
                    "Offset",
                    "Low MAE",
                    "Left MAE",
                    "Left",
                    "Left − a tenth [95 % interval]",
                ),
                [_rescaling_row(one) for one in sensors],
                caption=f"Fitted to {sensors[0].teaching} windows, scored on {sensors[0].judging} "
                "(virtual field). How an answer changes with the current is interpolated between "
                "settled currents; left out one by one, these are off by "
                + ", ".join(f"{name} {number(error)}" for name, error in off.items())
                + ". The interpolated change is zero where speed and direction stay.",
            ),
        ]

    def _null(self) -> list[Html]:
        null, real = self.null.null, self.null.real
        names = [*(one.sensor for one in null.sensors), "All together"]
        return [
            tag("h2", "The null case"),
            tag(
                "p",
                "Here the truth is the low fidelity itself: each sensor reads its answer in the "
                "water that the buoy reports, with the sensor's own noise, and trains level 2 as "
                "in a twin. Beside it stands the field as it is: same windows, same inputs, same "
                "number of readings. A method that gained in the null case would gain by a trick "
                "of its scoring. The noise is what the sensor really read less the truth, without "
                "faults, gain and each day's mean: what lasts for days, as the weather's air "
                "pressure does, no training can separate from a difference of the cage.",
            ),
            picture(
                gain_figure(names, _shares(null), _shares(real), origin=ORIGIN),
                caption="Low-fidelity less multifidelity absolute error, as a share of the "
                "low-fidelity error in the same case, with its 95 % interval by a paired block "
                "bootstrap with blocks of a day, or of an eighth of the readings where there are "
                "fewer days (virtual field). In the null case the low-fidelity error is the "
                "sensor's noise alone.",
                alternative="Gains in the null case and in the real case, by sensor",
                look="wide",
            ),
            self._gain_table(null, "Null case: readings are the low fidelity's answers and noise"),
            self._gain_table(real, "Real case: readings of the virtual field's sensors"),
        ]

    def _gain_table(self, gains: Gains, caption: str) -> Html:
        head = (
            "Sensor",
            "Teach",
            "Judge",
            "Low MAE",
            "Multi MAE",
            "Gain [95 % interval]",
            "Covers 0",
            "Means over",
        )
        rows = [(*_gain_row(one), f"{self.null.mean_s[one.sensor]:g} s") for one in gains.sensors]
        return table(head, rows, caption=f"{caption} (virtual field).")

    def _fouling(self) -> list[Html]:
        fouling = self.fouling
        figure = fouling_figure(
            _panels(self.gaps),
            fouling.growth,
            fouling.speed,
            fouling.gap,
            met_growth=np.array([met.growth for met in fouling.met]),
            met_gap=np.stack([met.gap for met in fouling.met]),
            origin=ORIGIN,
        )
        middle = len(fouling.speed) // 2
        rows = [
            (
                f"{name} [{unit}]",
                *(number(gap) for gap in fouling.gap[:, middle, column]),
                tag("small", ORIGIN),
            )
            for column, (name, unit) in enumerate(zip(fouling.sensors, fouling.units, strict=True))
        ]
        return [
            tag("h2", "The gap while the net grows"),
            tag(
                "p",
                "Lines: both cages settled in the same current, towards "
                f"{fouling.current_to:g}°, with the true net as grown as the axis says. Dots: the "
                "record's own windows sorted by the growth they had, in whatever currents and "
                "with the buoy's current instead of the cage's, so they lie where the record's "
                "mean current puts them.",
            ),
            picture(
                figure,
                caption="Truth less low fidelity from a net just cleaned, 0, to one grown out, 1 "
                "(virtual field).",
                alternative="Gap against growth, by sensor and current",
                look="wide",
            ),
            table(
                ("Growth", *(f"{growth:g}" for growth in fouling.growth), "Origin"),
                rows,
                caption=f"Truth less low fidelity, settled at {fouling.speed[middle]:g} m/s.",
            ),
        ]

    def _end(self) -> list[Html]:
        return [
            tag("h2", "What was done"),
            facts(self.recipe),
            tag("h2", "To repeat it"),
            facts(self.provenance),
            tag(
                "footer",
                "Every verdict on this page is computed from the numbers beside it. The virtual "
                "field is no measurement: that the two simulators differ does not say by how much "
                "a real cage differs from either.",
            ),
        ]


def _of(gap: SensorGap, sector: str, name: str) -> float:
    found = [float(getattr(one, name)) for one in gap.sectors if one.sector == sector]
    return found[0] if found else np.nan


def _panels(gaps: Sequence[SensorGap]) -> list[Panel]:
    quantity = {"m": "Rise", "kN": "Tension"}
    return [Panel(sensor=gap.sensor, quantity=quantity[gap.unit], unit=gap.unit) for gap in gaps]


def _rescaling_row(one: Rescaling) -> tuple[str, ...]:
    return (
        f"{one.sensor} [{one.unit}]",
        f"{one.factor:.2f}",
        f"{one.turn:.0f}".replace("-", "\N{MINUS SIGN}"),
        number(one.gain),
        number(one.offset),
        tag("span", number(one.low_mae), look="low"),
        number(one.left_mae),
        Html(bar(one.left) + percent(one.left)),
        tag(
            "span",
            f"{number(one.above_least.mean)} [{ends(one.above_least)}]",
            look="better" if one.enough else "worse",
        ),
    )


def _gain_row(one: Gain) -> tuple[str, ...]:
    gain = Interval(mean=1e3 * one.gain.mean, low=1e3 * one.gain.low, high=1e3 * one.gain.high)
    return (
        f"{one.sensor} [{THOUSANDTH[one.unit]}]",
        str(one.teaching),
        str(one.judging),
        tag("span", number(1e3 * one.low_mae), look="low"),
        tag("span", number(1e3 * one.multi_mae), look="multi"),
        f"{number(gain.mean)} [{ends(gain)}]",
        _zero(gain),
    )


def _zero(gain: Interval) -> str:
    if gain.covers_zero:
        return "yes"
    return "no, above" if gain.low > 0.0 else "no, below"


def _shares(gains: Gains) -> Float[np.ndarray, "row 3"]:
    rows = [*(one.share for one in gains.sensors), gains.together]
    return np.array([(row.mean, row.low, row.high) for row in rows])
