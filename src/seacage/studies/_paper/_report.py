"""The paper study as one HTML page that needs nothing beside itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Origin, Progress
from seacage.figures import (
    ShapeView,
    TrainingScores,
    net_figure,
    rows_figure,
    shape_cases_figure,
    shape_error_figure,
    shape_views_figure,
    training_scores_figure,
)
from seacage.ocean import SeaState
from seacage.studies._held_out import comparison, display_span
from seacage.studies._page import Html, bar, claims, facts, page, picture, table, tag
from seacage.studies._paper._claims import INCONSISTENT, UNJUDGED, PaperClaim, paper_claims
from seacage.studies._paper._discussion import NOMINAL, findings
from seacage.studies._paper._level_one import LevelOneScore
from seacage.studies._paper._shape_models import GCN_OURS, GCN_PAPER, PCA_PAPER, SHAPE_CURRENT
from seacage.studies._paper._shape_scores import ShapeScore
from seacage.studies._paper._shape_study import ShapeCase, ShapeStudy
from seacage.studies._paper._ways import ScoredWays, WayScore
from seacage.studies._sensor_scores import Errors, SensorScore
from seacage.studies._text import number, percent
from seacage.twin import Answer

_SHOWN_LOADS = ("shackle-1", "shackle-2", "shackle-5")
"""The bridles that the paper shows."""

_DRAWN_MODELS = (PCA_PAPER, GCN_PAPER, GCN_OURS, SHAPE_CURRENT)
_NETS = (PCA_PAPER, GCN_PAPER)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PaperReport:
    """Contents of the page.

    Parameters
    ----------
    cage, sea, answer
        The cage, and the twin's answer in one sea state to draw.
    scored
        Ways of teaching and their scores, with the readings of the first.
    level_one
        Scores of level 1 on held-out simulations.
    shapes
        Models of the whole shape on the same.
    recipe, provenance
        What was done and with what, as name and value.
    in_time
        Whether cage and field were simulated in time, in waves.
    progress
        Called as ("draw", done, total) in figures of sensors.
    """

    cage: Cage
    sea: SeaState
    answer: Answer
    scored: ScoredWays
    level_one: LevelOneScore
    shapes: ShapeStudy
    recipe: Mapping[str, str]
    provenance: Mapping[str, str]
    in_time: bool
    progress: Progress

    @property
    def claims(self) -> tuple[PaperClaim, ...]:
        """Of the paper, with what the numbers say of them."""
        return paper_claims(self.scored, self.shapes)

    @property
    def sensors(self) -> tuple[SensorScore, ...]:
        """Of the way that the page shows."""
        return self.scored.sensors

    def html(self) -> str:
        """The whole page."""
        return page(
            "The paper's study with seacage",
            self._header(),
            *self._method(),
            *self._sensors(),
            *self._errors(),
            *self._ways(),
            *self._shapes(),
            *self._level_one(),
            *self._discussion(),
            *self._provenance(),
        )

    def _header(self) -> Html:
        better = sum(score.means.better for score in self.sensors)
        ratio = float(np.median([score.means.ratio for score in self.sensors]))
        held = float(np.median([score.minutes.coverage for score in self.sensors]))
        reproduced = sum(claim.verdict == "reproduced" for claim in self.claims)
        tally = {
            "Sensors improved": f"{better} of {len(self.sensors)}",
            "Median error ratio": number(ratio),
            "Median coverage of 95 %": percent(held),
            "Shape emulator's error": f"{number(1000.0 * self.shapes.best.mae)} mm",
            "Statements reproduced": f"{reproduced} of {len(self.claims)}",
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
                "how its readings follow from the current and from level 1. Training "
                "days and validation days are apart; no day is in both.",
            ),
            facts(self.recipe),
            picture(figure, caption=caption, alternative="The net in side and top view"),
        ]

    def _sensors(self) -> list[Html]:
        """The paper's two figures of sensors, and those it leaves out."""
        names = [score.sensor for score in self.sensors if score.unit == "kN"]
        paper = [name for name in names if name in _SHOWN_LOADS] or names
        depths = [score.sensor for score in self.sensors if score.unit == "m"]
        groups = {
            "Mooring loads": paper,
            "Depths": depths,
            "The other bridles": [name for name in names if name not in paper],
        }
        drawn: list[Html] = []
        total = sum(map(bool, groups.values()))
        for title, group in groups.items():
            self.progress("draw", len(drawn) // 2, total)
            if group:
                drawn += [tag("h2", title), self._rows(group)]
        self.progress("draw", total, total)
        return drawn

    def _rows(self, sensors: Sequence[str]) -> Html:
        scores = {score.sensor: score for score in self.sensors}
        readings = self.scored.readings
        figure = rows_figure(
            [comparison(scores[name], readings[name]) for name in sensors],
            [display_span(readings[name]) for name in sensors],
        )
        counts = [
            f"{name} {scores[name].raw.readings:,} readings of {scores[name].told_h:,.0f} hours"
            for name in sensors
        ]
        return picture(
            figure,
            caption="Left and middle: predictions against all readings of days that did not "
            f"teach ({', '.join(counts)}); dashed y = x, red the best fit. Right: "
            "low fidelity, multifidelity with its 95 % interval for a mean over a minute, and the "
            "sensor, over the first unseen days or, where the record has gaps, its longest "
            "unbroken part. Every reading is of the virtual field.",
            alternative=f"Density scatters and time series of {', '.join(sensors)}",
            look="wide",
        )

    def _errors(self) -> list[Html]:
        return [
            tag("h2", "Errors on days not trained on"),
            self._error_table(
                [(score, score.means) for score in self.sensors],
                caption="10-minute means. MAE: mean absolute error of low fidelity and of "
                "multifidelity. Gain: low-fidelity less multifidelity absolute error, with its "
                "95 % interval by a paired block bootstrap.",
            ),
            self._error_table(
                [(score, score.raw) for score in self.sensors],
                caption="Single readings. Coverage: share of means over a minute, as they teach, "
                f"inside the {percent(NOMINAL)} interval. CRPS: continuous ranked probability "
                "score of multifidelity on the same. A sensor that trained no level 2 has no "
                "interval: its coverage and CRPS are of the emulator's own spread.",
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

    def _ways(self) -> list[Html]:
        """Other ways of training, beside the way shown."""
        if len(self.scored.ways) < 2:
            return []
        first = self.scored.ways[0]
        low = np.array([one.minutes.low_mae for one in first.sensors])
        figure = training_scores_figure(
            [one.sensor for one in first.sensors],
            {way.name: _way_bars(way, low) for way in self.scored.ways},
            origin=first.sensors[0].origin,
        )
        rows = [
            (
                f"{one.sensor} [{one.unit}]",
                way.name,
                "yes" if one.sensor in way.trained else "no",
                tag("span", number(one.minutes.low_mae), look="low"),
                tag("span", number(one.minutes.multi_mae), look="multi"),
                percent(one.minutes.coverage),
                number(one.minutes.crps),
                tag("small", one.origin),
            )
            for row in zip(*(way.sensors for way in self.scored.ways), strict=True)
            for way, one in zip(self.scored.ways, row, strict=True)
        ]
        head = ("Sensor", "Way", "Level 2", "Low MAE", "Multi MAE", "Coverage", "CRPS", "Origin")
        return [
            tag("h2", "Training readings and inputs"),
            tag(
                "p",
                "The paper's twin has the current alone as its input and learns from a few minutes "
                "of depths and a few seconds of loads; which ones, it does not say. The page's "
                f"figures take {_points(self.scored)} one-minute means "
                "spread over currents and days. Beside it stand readings in a row, five minutes "
                "of a depth and ten seconds of a load, and the same spread readings for a twin "
                "with waves as inputs. All are scored on the same means over a minute.",
            ),
            picture(
                figure,
                caption="Left: multifidelity error over the low fidelity's of a twin with "
                "the current as input. Middle: CRPS over the same. Right: share of means inside "
                "the 95 % interval (virtual field). A sensor without a level-2 model answers at "
                "level 1, with the emulator's own spread, which is no interval.",
                alternative="Errors, scores and coverage by way of training",
                look="wide",
            ),
            table(
                head,
                rows,
                caption="Means over a minute on the validation days. Level 2: whether the "
                "training window was long enough and the model better than level 1.",
            ),
        ]

    def _shapes(self) -> list[Html]:
        shapes = self.shapes
        drawn = [*(name for name in _DRAWN_MODELS if name in shapes.scores), shapes.best.model]
        case_errors = {name: shapes.scores[name].case_axis_mae for name in drawn}
        by_case = picture(
            shape_cases_figure(case_errors),
            caption=f"Mean absolute error over all nodes in each of {shapes.test_cases} held-out "
            "simulations (computed). The red line is the distance that the paper would "
            "have an ROV keep. Last panel: mean and standard deviation over the cases.",
            alternative="Errors along x, y and z by test case and model",
            look="wide",
        )
        speed = picture(
            shape_error_figure(
                shapes.current_speed,
                {name: case_errors[name].mean(axis=1) for name in self._net_models()},
            ),
            caption="The same errors, averaged over the axes, against the speed of the current.",
            alternative="Error of whole shapes against current speed",
            look="narrow",
        )
        return [
            tag("h2", "The whole shape"),
            *(tag("p", sentence) for sentence in shapes.left_out),
            by_case,
            self._nets(),
            self._shape_table(),
            speed,
        ]

    def _nets(self) -> Html:
        names = self._net_models()
        views = [
            ShapeView(
                title=f"{case.called}: {_sea(case.sea)}",
                computed=case.computed,
                predicted={name: case.predicted[name] for name in names},
            )
            for case in self.shapes.cases
        ]
        rows = "; ".join(f"{case.called.lower()} is {_which(case)}" for case in self.shapes.cases)
        return picture(
            shape_views_figure(views, self.cage.edges),
            caption="Predicted nets over simulated ones (computed), to one scale. The cases at "
            f"the 95th and the 20th percentile of the current's speed: {rows}.",
            alternative="Predicted and simulated nets in a harsh and a mild sea",
            look="wide",
        )

    def _net_models(self) -> list[str]:
        """The paper's two, of those that there are, and ours."""
        return [*(name for name in _NETS if name in self.shapes.scores), self.shapes.best.model]

    def _shape_table(self) -> Html:
        return table(
            (
                "Model",
                "x",
                "y",
                "z [mm]",
                "99 % [m]",
                "Worst [m]",
                "Covers",
                "CRPS [mm]",
                "Fit [s]",
                "Shape [ms]",
                "Inputs",
                "Origin",
            ),
            [_shape_row(score) for score in self.shapes.scores.values()],
            caption=f"Trained on {self.shapes.training_cases} simulations, tested on "
            f"{self.shapes.test_cases}. x, y, z: mean absolute errors. 99 %: of all nodes in all "
            "cases, so many are nearer than this to where they should be; worst is the farthest of "
            "them. Covers: share of coordinates inside the 95 % interval. Fit and shape: processor "
            "time to train and of one answer, in one run on a shared machine: only their ratios "
            "mean something.",
        )

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
        return [tag("h2", "Level 1 at the bridles"), bridles]

    def _discussion(self) -> list[Html]:
        paragraphs = findings(self.scored, self.level_one, self.shapes)
        both = (
            "Both are simulated in time, in waves, by the same kernel with other parts."
            if self.in_time
            else "But both are equilibria of the same net under a uniform current, without waves."
        )
        limits = (
            "The virtual field is no measurement. It differs from the low fidelity in load law, "
            f"fouling, stiffness, line lengths, current and sensors. {both} What is shown here is "
            "that the method can learn such differences, not how large they are at a real cage."
        )
        return [
            tag("h2", "Discussion"),
            tag("h3", "The paper's statements, held against these numbers"),
            claims((one.verdict, one.claim, one.finding) for one in self.claims),
            tag("h3", "What was found"),
            *(tag("p", finding) for finding in paragraphs),
            tag("p", limits),
            tag("h3", "What could not be evaluated"),
            tag("ul", *(tag("li", one) for one in UNJUDGED)),
            tag("h3", "Where the paper is at odds with itself"),
            tag("ul", *(tag("li", one) for one in INCONSISTENT)),
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
    spread = score.minutes if errors is score.raw else errors
    return (
        f"{score.sensor} [{score.unit}]",
        f"{errors.readings:,}",
        tag("span", number(errors.low_mae), look="low"),
        tag("span", number(errors.multi_mae), look="multi"),
        Html(bar(errors.ratio) + f"{errors.ratio:.2f}"),
        tag("span", f"{number(errors.gain)} [{interval}]", look=verdict),
        percent(spread.coverage),
        number(spread.crps),
        tag("small", score.origin),
    )


def _shape_row(score: ShapeScore) -> tuple[str, ...]:
    return (
        score.model,
        *(number(1000.0 * error) for error in score.axis_mae),
        number(score.p99),
        number(score.worst),
        percent(score.coverage),
        number(1000.0 * score.crps),
        number(score.fit_cpu_s),
        number(score.predict_ms),
        score.inputs,
        tag("small", Origin.COMPUTED),
    )


def _way_bars(way: WayScore, low: np.ndarray) -> TrainingScores:
    minutes = [one.minutes for one in way.sensors]
    return TrainingScores(
        error=np.array([one.multi_mae for one in minutes]) / low,
        crps=np.array([one.crps for one in minutes]) / low,
        coverage=np.array([one.coverage for one in minutes]),
    )


def _points(scored: ScoredWays) -> str:
    points = [one.points for one in scored.twin.provenance.training_windows.values()]
    return str(max(points)) if points else "no"


def _which(case: ShapeCase) -> str:
    return f"test case {case.row}, {_sea(case.sea)}"


def _sea(sea: SeaState) -> str:
    current = f"{sea.current_speed:.2f} m/s to {sea.current_to:.0f}°"
    return f"{current}, Hs {sea.hs:.1f} m" if sea.hs > 0.0 else current
