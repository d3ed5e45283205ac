"""The paper's study: simulations, sensors and the twin between them, scored and reported."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, Origin, Progress, no_progress
from seacage.records import CampaignRecord, FieldRecord, read_campaign
from seacage.studies._chain import Chain, Recipe, cases_with_answer
from seacage.studies._page import write_report
from seacage.studies._paper._claims import PaperClaim, paper_claims
from seacage.studies._paper._report import page_values
from seacage.studies._paper._sensor_baselines import BaselineScore, score_sensor_baselines
from seacage.studies._paper._shape_models import shape_models
from seacage.studies._paper._shape_scores import ShapeScore
from seacage.studies._paper._shape_study import ShapeStudy, ShapeTrial, shape_study
from seacage.studies._paper._trainings import ScoredWays, WayScore, compare_ways, has_waves, ways_of
from seacage.studies._paper._wave_loads import WaveLoads, wave_loads
from seacage.studies._sensor_scores import SensorScore
from seacage.studies._split import split
from seacage.studies._text import join_names
from seacage.twin import TrainingWindow, Twin


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LevelOneScore:
    """Level 1 against simulations that it has not seen."""

    cases: int
    # Mean absolute error and mean tension of each bridle [N]
    bridle_names: tuple[str, ...]
    bridle_mae: Float[np.ndarray, " line"]
    bridle_mean: Float[np.ndarray, " line"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PaperStudy:
    """Where the study's report is, and what it found."""

    # The HTML page and the same numbers as JSON
    report: Path
    scores: Path
    sensors: tuple[SensorScore, ...]  # the score of each sensor on days that it was not trained on
    level_one: LevelOneScore  # the score of level 1 on simulations that it has not seen
    ways: tuple[WayScore, ...]  # the scores of each way of training, that of ``sensors`` first
    shapes: tuple[ShapeScore, ...]  # the score of each model of the whole shape
    claims: tuple[PaperClaim, ...]  # of the paper, with their verdicts
    baselines: tuple[BaselineScore, ...]  # beside level 2, on the same readings
    loads: WaveLoads | None  # those in waves; None where they were not studied


def paper_study(
    # Folder of ``report.html``, ``scores.json`` and the stages they were made from; after a stop
    # the work goes on where it was
    out: str | Path,
    *,
    cage: Cage | None = None,  # None for that of the campaign given, or ``ace``
    # 400 equilibria without waves and a settled field, in minutes. Otherwise, and where a campaign
    # or a field is given, the paper's 1,000 half-hours, the last 100 held out, and a field in time.
    quick: bool = True,
    # A finished campaign to take in place of one made here; its last 100 cases are held out
    campaign: str | Path | None = None,
    # Folder of a virtual field with its truth in ``truth``, in place of one made here; the first
    # half of its days are training days
    field: str | Path | None = None,
    # A finished campaign of plan ``loads``, for the loads in waves, in place of one made here of
    # 120 cases when quick and of 480 otherwise
    loads: str | Path | None = None,
    # Of a field made in full size: its length, and to simulate one hour in so many and those of the
    # shackles
    days: float = 48.0,
    one_in: int = 1,
    # Whether to train graph networks, which takes minutes and JAX; None for not when quick
    networks: bool | None = None,
    seed: int = 0,  # of everything that is drawn
    workers: int | None = None,  # processes for simulations; None for one per core
    progress: Progress | None = None,  # called as (stage, done, total)
) -> PaperStudy:
    """Repeat the paper's study with a virtual field, into one HTML page.

    The paper's figures of loads, depths and shapes on days and simulations not trained on, with
    their errors; beside them other training readings and inputs, other models of the shape, and
    which of the paper's statements these numbers repeat.

    Raises InputError: the field is not virtual, or has too little on one side of the cut.
    """
    quick = quick and campaign is None and field is None
    chain = Chain(
        folder=Path(out) / "stages",
        cage=_cage(cage, campaign),
        recipe=Recipe(seed=seed) if quick else _full(field, days, one_in, seed),
        given_campaign=None if campaign is None else Path(campaign),
        given_field=None if field is None else Path(field),
        workers=workers,
        progress=progress or no_progress,
    )
    _check(chain)
    waves = wave_loads(
        chain, cases=120 if quick else 480, given=None if loads is None else Path(loads)
    )
    networks = not quick if networks is None else networks
    return study_chain(chain, Path(out), networks=networks, loads=waves)


def study_chain(
    chain: Chain, out: Path, *, networks: bool = False, loads: WaveLoads | None = None
) -> PaperStudy:
    """Score a chain and report on it, making the stages that are missing."""
    scored = compare_ways(chain, ways_of(chain.recipe, waves=has_waves(chain)))
    level_one = score_level_one(scored.twin, chain.held_out)
    days = split(chain.field, teaching_days=chain.recipe.teaching_days)
    baselines = tuple(score_sensor_baselines(scored.twin, *days, chain.recipe.training))
    shapes = _shapes(chain, networks=networks)
    claims = paper_claims(scored, shapes)
    shape_scores = tuple(shapes.scores.values())
    scores = {
        "recipe": _recipe(chain, scored, shapes),
        "provenance": _provenance(chain, scored),
        "origin": Origin.VIRTUAL_FIELD,
        "sensors": scored.sensors,
        "level_one": level_one,
        "ways": scored.ways,
        "shapes": shape_scores,
        "variance_of_three_modes": shapes.variance,
        "claims": claims,
        "sensor_baselines": baselines,
        "wave_loads": loads,
    }
    values = page_values(chain, scored, shapes, loads)
    written, numbers = write_report(out, "paper.html", scores, values)
    return PaperStudy(
        report=written,
        scores=numbers,
        sensors=scored.sensors,
        level_one=level_one,
        ways=scored.ways,
        shapes=shape_scores,
        claims=claims,
        baselines=baselines,
        loads=loads,
    )


def score_level_one(twin: Twin, held_out: CampaignRecord) -> LevelOneScore:
    """Score the tensions of level 1 on simulations that it has not seen."""
    held_out = cases_with_answer(held_out)
    tension, answer = held_out.bridle_tension, twin.predict(held_out.seas)
    return LevelOneScore(
        cases=len(held_out),
        bridle_names=twin.bridle_names,
        bridle_mae=np.mean(np.abs(answer.bridle_low - tension), axis=0),
        bridle_mean=np.mean(tension, axis=0),
    )


def _cage(cage: Cage | None, campaign: str | Path | None) -> Cage:
    if cage is not None:
        return cage
    if campaign is None:
        return Cage.named("ace")
    return Cage.from_toml(read_campaign(campaign).cage_toml, source=str(campaign))


def _full(field: str | Path | None, days: float, one_in: int, seed: int) -> Recipe:
    return Recipe(
        cases=900,
        held_out_cases=100,
        method="simulate",
        days=days,
        teaching_days=round(days / 2.0) if field is None else _first_half(field),
        one_in=one_in,
        seed=seed,
    )


def _first_half(field: str | Path) -> int:
    """Days up to the midnight that is nearest to the middle of a field record."""
    time = FieldRecord.read(field).buoy.time
    middle = time[0] + (time[-1] - time[0]) / 2
    return max(1, round((middle - time[0].astype("datetime64[D]")) / np.timedelta64(1, "D")))


def _check(chain: Chain) -> None:
    if chain.field.origin is not Origin.VIRTUAL_FIELD:
        raise InputError(
            f"study paper: the record's sensors are {chain.field.origin}, and no truth is known "
            "of them. Give a folder that `seacage field virtual` made, or score a twin on this "
            "record by `seacage score`."
        )


def _shapes(chain: Chain, *, networks: bool) -> ShapeStudy:
    models, left_out = shape_models(chain.cage, waves=chain.in_waves, networks=networks)
    return shape_study(
        models,
        ShapeTrial(
            cage=chain.cage,
            campaign=cases_with_answer(chain.campaign),
            held_out=cases_with_answer(chain.held_out),
            seed=chain.recipe.seed,
        ),
        chain.stages,
        left_out=left_out,
        progress=chain.progress,
    )


def _recipe(chain: Chain, scored: ScoredWays, shapes: ShapeStudy) -> dict[str, str]:
    recipe, campaign, field = chain.recipe, chain.campaign, chain.field
    what = "half-hours in waves and currents" if chain.in_waves else "currents settled"
    readings = sum(len(sensor) for sensor in field.sensors.values())
    begin, end = (str(time)[:10] for time in field.buoy.time[[0, -1]])
    return {
        "Simulations (computed)": f"{np.sum(campaign.converged)} of {len(campaign)} {what}, "
        f"0 to 1 m/s from all sides, law {campaign.law}",
        "Held-out simulations (computed)": f"{shapes.test_cases}, none of which was trained on",
        "Buoy record and sensors (virtual field)": f"{begin} to {end}, {readings:,} readings of "
        f"{len(field.sensors)} sensors",
        "Days": f"the first {recipe.teaching_days} train, the later ones validate",
        **_training_windows(scored.twin.provenance.training_windows),
    }


def _training_windows(windows: Mapping[str, TrainingWindow]) -> dict[str, str]:
    """Training windows of the sensors, those with the same window in one line."""
    alike: dict[TrainingWindow, list[str]] = {}
    for name, window in windows.items():
        alike.setdefault(window, []).append(name)
    return {
        f"{join_names(names)} (virtual field)": f"trained on {window.points} readings each, "
        f"{window.start:%d %b %H:%M} to {window.end:%d %b %H:%M} UTC"
        for window, names in alike.items()
    }


def _provenance(chain: Chain, scored: ScoredWays) -> dict[str, str]:
    provenance = scored.twin.provenance
    return {
        "seacage": provenance.version,
        "Seed": str(chain.recipe.seed),
        "Cage": f"{chain.cage.name}, sha256 {chain.cage.sha256}",
        "Campaign": f"seed {provenance.campaign_seed}, sha256 {provenance.campaign_sha256}",
        "Hidden parameters": f"sha256 {provenance.hidden_sha256}",
        "Sensors": str(provenance.origin),
        "Notes": "\n".join(chain.field.notes),
    }
