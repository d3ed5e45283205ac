"""The paper study's page: its figures, for the template ``paper.html``."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from seacage import figures as drawings
from seacage.conventions import Origin
from seacage.ocean import SeaState
from seacage.studies._chain import Chain
from seacage.studies._held_out import comparison, display_span
from seacage.studies._paper._shape_models import (
    GCN_OURS,
    GCN_PAPER,
    PCA_PAPER,
    PCA_WAVES,
    SHAPE_CURRENT,
)
from seacage.studies._paper._shape_study import ShapeCase, ShapeStudy
from seacage.studies._paper._trainings import HEARING, ScoredWays, WayScore
from seacage.studies._paper._wave_loads import BASELINES, METHODS, STATISTICS, WaveLoads
from seacage.studies._stages import count

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN_SPEED = 0.6  # of the current that the net is drawn in [m/s]
_NOMINAL = 0.95  # coverage of the intervals
_SHOWN_LOADS = ("shackle-1", "shackle-2", "shackle-5")  # the bridles that the paper shows
_DRAWN_MODELS = (PCA_PAPER, GCN_PAPER, GCN_OURS, SHAPE_CURRENT)
_NETS = (PCA_PAPER, GCN_PAPER)


def page_values(
    chain: Chain, scored: ScoredWays, shapes: ShapeStudy, loads: WaveLoads | None
) -> dict[str, object]:
    """Figures and names of the page besides the scores.

    The chain's progress is called as ("draw", done, total) in figures of sensors.
    """
    sea = SeaState(current_speed=_SHOWN_SPEED, current_to=chain.cage.site.current_to)
    return {
        "cage": chain.cage,
        "sea": sea,
        "scored": scored,
        "shapes": shapes,
        "in_time": chain.recipe.in_time,
        "methods": METHODS,
        "baselines": BASELINES,
        "statistics": tuple(STATISTICS.values()),
        "computed": Origin.COMPUTED,
        **finding_values(scored),
        "drawn": _draw_sensors(chain, scored),
        "trained": [
            (way, one)
            for row in zip(*(way.sensors for way in scored.ways), strict=True)
            for way, one in zip(scored.ways, row, strict=True)
        ],
        "pictures": {
            "net": _draw_net(chain, scored, sea),
            "ways": _draw_ways(scored.ways),
            "loads": draw_wave_loads(loads) if loads and loads.scores else None,
            **_draw_shapes(chain, shapes),
        },
    }


def finding_values(scored: ScoredWays) -> dict[str, object]:
    """Names and numbers that the template ``findings.html`` takes besides the scores."""
    current = {one.sensor: one for one in scored.sensors}
    with_waves = [way.sensors for way in scored.ways if way.name == HEARING]
    pairs = [(one, current[one.sensor]) for sensors in with_waves for one in sensors]
    gain_of_waves = pairs and {
        "better": [a.sensor for a, b in pairs if a.means.multi_mae < b.means.multi_mae],
        "low": [a.sensor for a, b in pairs if a.means.low_mae < b.means.low_mae],
        "change": np.median([a.means.multi_mae / b.means.multi_mae - 1.0 for a, b in pairs]),
    }
    return {
        "gain_of_waves": gain_of_waves,
        "nominal": _NOMINAL,
        "pca": {"paper": PCA_PAPER, "waves": PCA_WAVES},
        "shape_current": SHAPE_CURRENT,
    }


def _draw_net(chain: Chain, scored: ScoredWays, sea: SeaState) -> "Figure":
    answer = scored.twin.predict(sea)
    return drawings.net_figure(
        chain.cage, answer.node_position[0], bridle_tension=answer.bridle_low[0], sea=sea
    )


def _draw_sensors(chain: Chain, scored: ScoredWays) -> list[dict[str, object]]:
    """The paper's two figures of sensors, and those it leaves out."""
    loads = [score for score in scored.sensors if score.unit == "kN"]
    paper = [score for score in loads if score.sensor in _SHOWN_LOADS] or loads
    groups = (
        ("Mooring loads", paper),
        ("Depths", [score for score in scored.sensors if score.unit == "m"]),
        ("The other bridles", [score for score in loads if score not in paper]),
    )
    drawn: list[dict[str, object]] = []
    for title, scores in count([one for one in groups if one[1]], "draw", chain.progress):
        readings = [scored.readings[score.sensor] for score in scores]
        figure = drawings.rows_figure(
            list(map(comparison, scores, readings)), list(map(display_span, readings))
        )
        drawn.append({"title": title, "scores": scores, "picture": figure})
    return drawn


def _draw_ways(ways: Sequence[WayScore]) -> "Figure | None":
    """Other ways of training, beside the way shown."""
    if len(ways) < 2:
        return None
    sensors = ways[0].sensors
    low = np.array([one.minutes.low_mae for one in sensors])
    scores = {
        way.name: drawings.TrainingScores(
            error=np.array([one.minutes.multi_mae for one in way.sensors]) / low,
            crps=np.array([one.minutes.crps for one in way.sensors]) / low,
            coverage=np.array([one.minutes.coverage for one in way.sensors]),
        )
        for way in ways
    }
    names = [one.sensor for one in sensors]
    return drawings.training_scores_figure(names, scores, origin=sensors[0].origin)


def draw_wave_loads(loads: WaveLoads) -> "Figure":
    """Errors of each statistic by method, a dot for each shackle."""
    contests = list[drawings.Contest]()
    for name in STATISTICS.values():
        some = [one.error for one in loads.scores if one.statistic == name]
        error = np.array([[one[method] for one in some] for method in METHODS])
        if some:
            none = np.full(len(METHODS), np.nan)
            contests.append(drawings.Contest(title=name.capitalize(), error=error, coverage=none))
    label = f"Median error over the reading ({loads.scores[0].origin})"
    methods = [one.capitalize() for one in METHODS]
    return drawings.error_figure(methods, contests, ours=(0, 1), label=label)


def _draw_shapes(chain: Chain, shapes: ShapeStudy) -> "dict[str, Figure]":
    best = shapes.best.model
    drawn = [*(name for name in _DRAWN_MODELS if name in shapes.scores), best]
    nets = [*(name for name in _NETS if name in shapes.scores), best]  # the paper's two, and ours
    errors = {name: shapes.scores[name].case_axis_mae for name in drawn}
    views = [
        drawings.ShapeView(
            title=_title(case),
            computed=case.computed,
            predicted={name: case.predicted[name] for name in nets},
        )
        for case in shapes.cases
    ]
    return {
        "cases": drawings.shape_cases_figure(errors),
        "nets": drawings.shape_views_figure(views, chain.cage.edges),
        "speeds": drawings.shape_error_figure(
            shapes.current_speed, {name: errors[name].mean(axis=1) for name in nets}
        ),
    }


def _title(case: ShapeCase) -> str:
    sea = case.sea
    waves = f", Hs {sea.hs:.1f} m" if sea.hs > 0.0 else ""
    return f"{case.called}: {sea.current_speed:.2f} m/s to {sea.current_to:.0f}°{waves}"
