"""The paper study as one HTML page that needs nothing beside itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Origin, Progress
from seacage.figures import density_figure, net_figure, series_figure, shape_error_figure
from seacage.ocean import SeaState
from seacage.studies._discussion import NOMINAL, findings, number, percent
from seacage.studies._held_out import SHOWN_DAYS, comparison, shown
from seacage.studies._level_one import LevelOneScore
from seacage.studies._page import Html, bar, facts, page, picture, table, tag
from seacage.studies._sensor_scores import Errors, Readings, SensorScore
from seacage.twin import Answer


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PaperReport:
    """What the page is written from.

    Parameters
    ----------
    cage, sea, answer
        The cage, and the twin's answer in one sea state to draw.
    sensors, readings
        The scores, and the readings behind them by sensor.
    level_one
        Scores of level 1 on held-out simulations.
    recipe, provenance
        What was done and with what, as name and value.
    progress
        Called as ("draw", done, total) in sensors.
    """

    cage: Cage
    sea: SeaState
    answer: Answer
    sensors: Sequence[SensorScore]
    readings: Mapping[str, Readings]
    level_one: LevelOneScore
    recipe: Mapping[str, str]
    provenance: Mapping[str, str]
    progress: Progress

    def html(self) -> str:
        """The whole page."""
        return page(
            "The paper's study with seacage",
            self._header(),
            *self._method(),
            *self._errors(),
            *self._sensors(),
            *self._level_one(),
            *self._discussion(),
            *self._provenance(),
        )

    def _header(self) -> Html:
        better = sum(score.means.better for score in self.sensors)
        ratio = float(np.median([score.means.ratio for score in self.sensors]))
        held = float(np.median([score.raw.coverage for score in self.sensors]))
        shape = 1000.0 * float(np.mean(self.level_one.shapes[0].axis_mae))
        tally = {
            "Sensors improved": f"{better} of {len(self.sensors)}",
            "Median error ratio": number(ratio),
            "Median coverage of 95 %": percent(held),
            "Shape emulator's error": f"{number(shape)} mm",
        }
        cells = (tag("div", tag("dt", name), tag("dd", value)) for name, value in tally.items())
        return tag(
            "header",
            tag("span", "Virtual field", look="badge"),
            tag("h1", "Two fidelities, one cage"),
            tag(
                "p",
                "How much a few hours of sensor readings add to many simulations: the "
                "multifidelity study of Katsidoniotaki, Su, Kelasidi and Sapsis, repeated with "
                f"cage {self.cage.name}. Every sensor reading on this page is virtual: it was "
                "computed with other physics and hidden parameters, because the field data of "
                "the paper are not public.",
                look="lead",
            ),
            tag("dl", *cells, look="tally"),
        )

    def _method(self) -> list[Html]:
        figure = net_figure(
            self.cage,
            self.answer.node_position[0],
            bridle_tension=self.answer.bridle_low[0],
            sea=self.sea,
        )
        caption = (
            f"Cage {self.cage.name} at {self.sea.current_speed:g} m/s, as level 1 answers "
            "(computed). Grey: the shape the net was cut to. Red discs are the depth sensors, "
            "diamonds the shackles."
        )
        return [
            tag("h2", "What was done"),
            tag(
                "p",
                "Level 1 learns from simulations alone: the tensions of all bridles and the shape "
                "of the whole net, as functions of the current. Level 2 learns, for each sensor, "
                "how its readings follow from the current and from level 1. The days that teach "
                "and the days that judge are apart; no day is in both.",
            ),
            facts(self.recipe),
            picture(figure, caption=caption, alternative="The net in side and top view"),
        ]

    def _errors(self) -> list[Html]:
        return [
            tag("h2", "Errors on days not trained on"),
            self._error_table(
                [(score, score.means) for score in self.sensors],
                caption="10-minute means. MAE: mean absolute error of low fidelity and of "
                "multifidelity.",
            ),
            self._error_table(
                [(score, score.raw) for score in self.sensors],
                caption="Single readings. Gain: low-fidelity less multifidelity "
                "absolute error, with its 95 % interval by a paired block bootstrap. Coverage: "
                f"share of readings inside the {percent(NOMINAL)} interval. CRPS: continuous "
                "ranked probability score of multifidelity.",
            ),
        ]

    def _error_table(self, rows: Sequence[tuple[SensorScore, Errors]], *, caption: str) -> Html:
        head = (
            "Sensor",
            "Readings",
            "Low MAE",
            "Multi MAE",
            "Ratio",
            "Gain [95 % interval]",
            "Coverage",
            "CRPS",
            "Origin",
        )
        return table(head, [_error_row(*row) for row in rows], caption=caption)

    def _sensors(self) -> list[Html]:
        sections: list[Html] = []
        for score in self.sensors:
            self.progress("draw", len(sections), len(self.sensors))
            sections.append(self._sensor(score))
        self.progress("draw", len(sections), len(sections))
        return sections

    def _sensor(self, score: SensorScore) -> Html:
        drawn = comparison(score, self.readings[score.sensor])
        start, end = shown(self.readings[score.sensor])
        density = picture(
            density_figure(drawn),
            caption=f"{score.sensor}, {score.origin}: against all {score.raw.readings:,}"
            f" readings of {score.span_h:,.0f} unseen hours. Dashed: y = x; red: best fit, of "
            f"slope {number(score.low_line[0])} at low fidelity and {number(score.multi_line[0])} "
            "at multifidelity.",
            alternative=f"Density scatters of {score.sensor}, low fidelity and multifidelity",
            look="narrow",
        )
        series = picture(
            series_figure(drawn, start=start, end=end),
            caption=f"{score.sensor}, {score.origin}: {_span(score)}.",
            alternative=f"Time series of {score.sensor}, low fidelity and multifidelity",
        )
        return tag("section", tag("h3", _titled(score)), density, series, look="sensor")

    def _level_one(self) -> list[Html]:
        level_one = self.level_one
        bridles = table(
            ("Bridle", "MAE [N]", "Mean tension [kN]", "MAE / mean", "Origin"),
            [
                (
                    name,
                    number(mae),
                    number(mean / 1000.0),
                    percent(mae / mean, digits=2),
                    tag("small", Origin.COMPUTED),
                )
                for name, mae, mean in zip(
                    level_one.bridle_names,
                    level_one.bridle_mae,
                    level_one.bridle_mean,
                    strict=True,
                )
            ],
            caption=f"Tensions of level 1 against {level_one.cases} held-out simulations.",
        )
        shapes = table(
            (
                "Model of the shape",
                "MAE x [mm]",
                "MAE y [mm]",
                "MAE z [mm]",
                "99 % of nodes [m]",
                "Worst node [m]",
                "Origin",
            ),
            [
                (
                    shape.model,
                    *(number(1000.0 * error) for error in shape.axis_mae),
                    number(shape.p99),
                    number(shape.worst),
                    tag("small", Origin.COMPUTED),
                )
                for shape in level_one.shapes
            ],
            caption=f"Shapes against {level_one.cases} held-out simulations. 99 % of nodes: of all "
            "nodes in all cases, so many are nearer than this to where they should be.",
        )
        figure = picture(
            shape_error_figure(
                level_one.current_speed,
                {shape.model: shape.case_mae for shape in level_one.shapes},
            ),
            caption="Mean absolute error over nodes and axes, one dot for each held-out "
            "simulation. The red line is the distance that the paper would have an ROV keep.",
            alternative="Error of whole shapes against current speed",
            look="narrow",
        )
        return [tag("h2", "Level 1 against held-out simulations"), shapes, figure, bridles]

    def _discussion(self) -> list[Html]:
        limits = (
            "The virtual field is no measurement. It differs from the low fidelity in load law, "
            "fouling, stiffness, line lengths, current and sensors, but both are equilibria of "
            "the same net under a uniform current, without waves. What is shown here is that the "
            "method can learn such differences, not how large they are at a real cage."
        )
        return [
            tag("h2", "Discussion"),
            *(tag("p", finding) for finding in findings(self.sensors, self.level_one)),
            tag("p", limits),
        ]

    def _provenance(self) -> list[Html]:
        return [
            tag("h2", "To repeat it"),
            facts(self.provenance),
            tag(
                "footer",
                "A. Katsidoniotaki, B. Su, E. Kelasidi, T. P. Sapsis: Multifidelity digital twin "
                "for real-time monitoring of structural dynamics in aquaculture net cages. "
                "Scientific Reports 15:44281 (2025). The paper prints no error figures in its "
                "text, so none is set beside ours.",
            ),
        ]


def _error_row(score: SensorScore, errors: Errors) -> tuple[str, ...]:
    interval = f"{number(errors.gain_low)} … {number(errors.gain_high)}"
    verdict = "better" if errors.better else "worse" if errors.worse else "unproven"
    return (
        f"{score.sensor} [{score.unit}]",
        f"{errors.readings:,}",
        tag("span", number(errors.low_mae), look="low"),
        tag("span", number(errors.multi_mae), look="multi"),
        Html(bar(errors.ratio) + f"{errors.ratio:.2f}"),
        tag("span", f"{number(errors.gain)} [{interval}]", look=verdict),
        percent(errors.coverage),
        number(errors.crps),
        tag("small", score.origin),
    )


def _titled(score: SensorScore) -> str:
    return (
        f"{score.sensor}: error {number(score.raw.low_mae)} → {number(score.raw.multi_mae)} "
        f"{score.unit}"
    )


def _span(score: SensorScore) -> str:
    if score.span_h > 24.0 * SHOWN_DAYS:
        return f"the first {SHOWN_DAYS} unseen days"
    return f"all {score.span_h:.0f} unseen hours"
