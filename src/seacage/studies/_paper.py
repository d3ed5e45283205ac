"""The paper's study: simulations, sensors and the twin between them, scored and told."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Progress
from seacage.ocean import SeaState
from seacage.studies._chain import Chain, Recipe
from seacage.studies._discussion import listed
from seacage.studies._held_out import write_scores
from seacage.studies._level_one import LevelOneScore, score_level_one
from seacage.studies._report import PaperReport
from seacage.studies._sensor_scores import Readings, SensorScore, compared, score_sensor
from seacage.studies._split import split
from seacage.twin import Lesson

_SHOWN_SPEED = 0.6
"""Of the current that the report draws the net in [m/s]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PaperStudy:
    """Where the study's report is, and what it found.

    Parameters
    ----------
    report, scores
        The HTML page and the same numbers as JSON.
    sensors
        The score of each sensor on days that it did not teach.
    level_one
        The score of level 1 on simulations that it has not seen.
    """

    report: Path
    scores: Path
    sensors: tuple[SensorScore, ...]
    level_one: LevelOneScore


def paper_study(
    out: str | Path,
    *,
    cage: Cage | None = None,
    quick: bool = True,
    seed: int = 0,
    workers: int | None = None,
    progress: Progress | None = None,
) -> PaperStudy:
    """Repeat the paper's study with a virtual field, into one HTML page.

    Per sensor: density scatters and time series of both fidelities on days not trained on,
    and their errors. Besides: level 1 against held-out simulations.

    Parameters
    ----------
    out
        Folder of ``report.html``, ``scores.json`` and the stages they were made from; after a
        stop the work goes on where it was.
    cage
        The cage; None for ``ace``.
    quick
        400 simulations instead of the paper's 1,000.
    seed
        Of everything that is drawn.
    workers
        Processes for simulations; None for one per core.
    progress
        Called as (stage, done, total).
    """
    recipe = Recipe(seed=seed) if quick else Recipe(seed=seed, cases=1000, held_out_cases=250)
    chain = Chain(
        folder=Path(out) / "stages",
        cage=Cage.named("ace") if cage is None else cage,
        recipe=recipe,
        workers=workers,
        progress=progress,
    )
    return study_chain(chain, Path(out))


def study_chain(chain: Chain, out: Path) -> PaperStudy:
    """Score a chain and tell it, making what it still lacks."""
    readings, sensors = _scored(chain)
    level_one = score_level_one(chain.twin, chain.campaign, chain.held_out, seed=chain.recipe.seed)
    sea = SeaState(current_speed=_SHOWN_SPEED, current_to=chain.cage.site.current_to)
    recipe, provenance = _recipe(chain, level_one), _provenance(chain)
    page = PaperReport(
        cage=chain.cage,
        sea=sea,
        answer=chain.twin.predict(sea),
        sensors=sensors,
        readings=readings,
        level_one=level_one,
        recipe=recipe,
        provenance=provenance,
        progress=chain.report,
    ).html()
    scores = {
        "recipe": recipe,
        "provenance": provenance,
        "sensors": sensors,
        "level_one": level_one,
    }
    study = PaperStudy(
        report=out / "report.html",
        scores=out / "scores.json",
        sensors=sensors,
        level_one=level_one,
    )
    write_scores(study.scores, scores)
    study.report.write_text(page, encoding="utf-8")
    return study


def _scored(chain: Chain) -> tuple[dict[str, Readings], tuple[SensorScore, ...]]:
    """The readings of the days that judge, beside the twin's predictions, and their scores."""
    days = chain.recipe.teaching_days
    _, judging = split(chain.field, teaching_days=days)
    _, judging_truth = split(chain.truth, teaching_days=days)
    answer = chain.twin.predict_record(chain.field.buoy)
    readings = compared(answer, judging)
    truth = compared(answer, judging_truth)
    scores: list[SensorScore] = []
    for name, one in readings.items():
        chain.report("score", len(scores), len(readings))
        scores.append(score_sensor(one, seed=chain.recipe.seed, truth=truth[name]))
    chain.report("score", len(scores), len(scores))
    return readings, tuple(scores)


def _recipe(chain: Chain, level_one: LevelOneScore) -> dict[str, str]:
    recipe, campaign = chain.recipe, chain.campaign
    return {
        "Simulations (computed)": f"{np.sum(campaign.converged)} of {len(campaign)} currents "
        f"settled, 0 to 1 m/s from all sides, law {campaign.law}",
        "Held-out simulations (computed)": f"{level_one.cases}, drawn with another seed",
        "Buoy record (virtual field)": f"{recipe.days:g} days from {recipe.start:%d %B %Y}; tide, "
        "weather and noise",
        "Days": f"the first {recipe.teaching_days} teach, the later ones judge",
        **_lessons(chain.twin.provenance.lessons),
    }


def _lessons(lessons: Mapping[str, Lesson]) -> dict[str, str]:
    """Who taught what, sensors that taught alike in one line."""
    alike: dict[Lesson, list[str]] = {}
    for name, lesson in lessons.items():
        alike.setdefault(lesson, []).append(name)
    return {
        f"{listed(names)} (virtual field)": f"taught with {lesson.points} readings each, "
        f"{lesson.start:%d %b %H:%M} to {lesson.end:%d %b %H:%M} UTC"
        for lesson, names in alike.items()
    }


def _provenance(chain: Chain) -> dict[str, str]:
    provenance = chain.twin.provenance
    return {
        "seacage": provenance.version,
        "Seed": str(chain.recipe.seed),
        "Cage": f"{chain.cage.name}, sha256 {_sha256(chain.cage.to_toml())}",
        "Campaign": f"seed {provenance.campaign_seed}, sha256 {provenance.campaign_sha256}",
        "Hidden parameters": f"sha256 {provenance.hidden_sha256}",
        "Sensors": str(provenance.origin),
        "Notes": "\n".join(chain.field.notes),
    }


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
