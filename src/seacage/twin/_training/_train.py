"""Training: the simulations teach level 1, each sensor teaches its own level 2."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import Literal

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, NonsenseError, Origin, Progress, unheard
from seacage.records import CampaignRecord, FieldRecord, moment
from seacage.surrogates import (
    Domain,
    FittedGaussianProcess,
    GaussianProcess,
    ShapeGP,
    mnll,
    window_design,
)
from seacage.twin._correction import Correction
from seacage.twin._metocean import INPUT_KEYS, Input, Metocean
from seacage.twin._models import Models
from seacage.twin._pairs import Pairs, align, spread_out, teaching_window
from seacage.twin._provenance import Lesson, Provenance
from seacage.twin._training._calibration import Lessons, Taught, calibrated
from seacage.twin._twin import Twin

KERNELS = ("matern-5/2", "squared-exponential")
"""For the bridles: the one with kinks, as of lines going slack, and the smooth one."""

LEAST_CASES = 20
LEAST_PAIRS = 20
"""Fewer than these say nothing about a cage."""

PAPER_WINDOW_S = {"depth_m": 300.0, "tension_kn": 10.0}
PAPER_LEAST = 5
"""The paper's "few minutes" of a depth sensor and "few seconds" of a shackle [s], which it does
not count; of slow sensors so many readings in a row."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Training:
    """What a twin learns from, and how much of it.

    Parameters
    ----------
    inputs
        What the models are asked with; waves need a campaign and a buoy that have them.
    high_fidelity_points
        Readings that each sensor teaches with, at most.
    choice
        ``"spread"`` over currents and time, or ``"paper"``: the single readings of a few
        minutes (depth) or a few seconds (shackles) from the first on, which teaches the noise
        of one hour and too narrow intervals; nothing is left to calibrate them on.
    days
        Longest that a sensor teaches [d]; later days are left to judge the twin.
    pause_s
        A sensor silent for longer has taught enough: what follows judges the twin [s].
    mean_s
        Readings are averaged over so long, and the intervals are of such means [s].
    restarts
        Random starts of each search for hyperparameters, beside the deterministic one.
    seed
        Of the choice of readings and of the searches.
    """

    inputs: tuple[Input, ...] = ("current",)
    high_fidelity_points: int = 300
    choice: Literal["spread", "paper"] = "spread"
    days: float = 25.0
    pause_s: float = 86400.0
    mean_s: float = 60.0
    restarts: int = 3
    seed: int = 0


def train(
    cage: Cage,
    campaign: CampaignRecord | None,
    field: FieldRecord | None = None,
    *,
    base: Twin | None = None,
    training: Training | None = None,
    progress: Progress | None = None,
) -> Twin:
    """Train a twin.

    Level 1 learns bridle tensions and shape from the campaign's converged cases. Each sensor
    of the field record then teaches its own level 2 (NARGP) on top: a shackle on its bridle's
    tension, a depth sensor on the depth of its node in the reconstructed shape. A sensor
    without enough sound readings, or whose readings level 1 meets as well as what they taught,
    stays at level 1. The intervals are calibrated on readings that did not teach: a sensor's
    own, or for a short lesson those of sensors that stayed longer.

    Parameters
    ----------
    cage
        Must be the campaign's; its sensors may have moved.
    campaign
        Of the low fidelity; None with a base.
    field
        None trains level 1 alone.
    base
        A twin of the same cage whose level 1 is taken as it is, and level 2 of every sensor
        that has not moved: only sensors that moved, or are new, are taught.
    training
        What to learn from; the default suits one buoy and 300 readings of each sensor.
    progress
        Called after each model.

    Raises
    ------
    NonsenseError
        Inputs that the field's buoy or the campaign never had.
    """
    training = Training() if training is None else training
    report: Progress = progress or unheard
    _check_inputs(campaign, field, training)
    begun = _begun(cage, campaign, field, base, training, report)
    kept = begun.models.upper
    asked = [name for name in cage.sensor_names if field and name in field.sensors]
    lessons = Lessons(
        models=begun.models,
        taught={
            name: one
            for name in asked
            if field and (one := _taught(field, name, training)) is not None
        },
        restarts=training.restarts,
        seed=training.seed,
        choose=lambda pairs: _chosen(pairs, training),
    )
    models, told = begun.models, dict(begun.provenance.lessons)
    for done, name in enumerate(asked, start=3):
        if name not in kept and (model := _learned(lessons, name)) is not None:
            models = models.taught(name, model)
            told[name] = replace(lessons.taught[name].lesson, calibrated=model.spread.by)
        report(f"train {name}", done, 2 + len(asked))
    new = field is not None and told != begun.provenance.lessons
    provenance = replace(
        begun.provenance,
        origin=field.origin if field and new else begun.provenance.origin,
        hidden_sha256=field.hidden_sha256 if field else begun.provenance.hidden_sha256,
        seed=training.seed,
        lessons=told,
    )
    return replace(begun, models=models, provenance=provenance)


def _check_inputs(
    campaign: CampaignRecord | None, field: FieldRecord | None, training: Training
) -> None:
    for key in (key for name in training.inputs for key in INPUT_KEYS[name]):
        if field and not (key in field.buoy.values and np.any(field.buoy.usable(key))):
            raise NonsenseError(
                f"train: {field.buoy.stream} has no {key}, which the inputs "
                f"{','.join(training.inputs)} ask for. Train with what it has."
            )
    if campaign and "waves" in training.inputs and not any(sea.hs for sea in campaign.seas):
        raise NonsenseError(
            "train: the campaign has no waves, which the inputs ask for. Simulate one with waves."
        )


def update(twin: Twin, field: FieldRecord, *, points: int = 60, mean_s: float = 60.0) -> Twin:
    """Take in what sensors have said since their lessons, without learning anew.

    Level 2 of each sensor is conditioned on more readings; its hyperparameters, its gain and
    its intervals' calibration stay, and level 1 is not touched. Every reading makes the twin a
    little slower: where they have doubled, train again.

    Parameters
    ----------
    twin
        Whose sensors have taught it.
    field
        Has later readings of some of them.
    points
        Readings of each sensor that are taken in, at most, spread over currents and time.
    mean_s
        Readings are averaged over so long, as in the training [s].
    """
    models, lessons = twin.models, dict(twin.provenance.lessons)
    for name, model in twin.models.upper.items():
        if name not in field.sensors:
            continue
        pairs = align(field, name, start=lessons[name].end, mean_s=mean_s)
        pairs = _known(pairs, models.inputs)
        if len(pairs) == 0:
            continue
        end = moment(pairs.time[-1]) + timedelta(seconds=mean_s)
        pairs = spread_out(pairs, points, seed=twin.provenance.seed)
        x = pairs.metocean.features(models.inputs)
        models = models.taught(name, model.updated(pairs, x))
        lesson = lessons[name]
        lessons[name] = replace(lesson, end=end, points=lesson.points + len(pairs))
    return replace(twin, models=models, provenance=replace(twin.provenance, lessons=lessons))


def _begun(
    cage: Cage,
    campaign: CampaignRecord | None,
    field: FieldRecord | None,
    base: Twin | None,
    training: Training,
    report: Progress,
) -> Twin:
    """Level 1, and level 2 of the sensors that have not moved since the base."""
    if (campaign is None) == (base is None):
        raise InputError(
            "train: give either a campaign, to teach level 1, or a base, whose level 1 is taken."
        )
    if base is not None:
        report("train bridles", 1, 2)
        report("train shape", 2, 2)
        return _from_base(cage, base, training)
    assert campaign is not None
    total = 2 + sum(name in field.sensors for name in cage.sensor_names) if field else 2
    models, kernel = _level_one(cage, campaign, training, report, total)
    provenance = Provenance(
        version=_version(),
        law=campaign.law,
        campaign_seed=campaign.seed,
        campaign_sha256=campaign.sha256,
        cases=int(np.sum(campaign.converged)),
        kernel=kernel,
        origin=Origin.COMPUTED,
        hidden_sha256=None,
        seed=training.seed,
    )
    return Twin(models=models, provenance=provenance, buoy=field.buoy.stream if field else "buoy-1")


def _from_base(cage: Cage, base: Twin, training: Training) -> Twin:
    before = base.cage
    if replace(cage, shackle=before.shackle, depth_sensor=before.depth_sensor) != before:
        raise InputError(
            f"train: {cage.name} differs from the base's cage by more than its sensors. Simulate "
            "it and give the campaign."
        )
    if training.inputs != base.models.inputs:
        raise InputError(
            f"train: the base is asked with {' and '.join(base.models.inputs)}, not with "
            f"{' and '.join(training.inputs)}. Ask for the same, or give a campaign."
        )
    places, now = _places(before), _places(cage)
    stay = [name for name in base.models.upper if now.get(name) == places[name]]
    lessons = base.provenance.lessons
    return replace(
        base,
        models=replace(
            base.models, cage=cage, upper={name: base.models.upper[name] for name in stay}
        ),
        provenance=replace(
            base.provenance,
            lessons={name: lessons[name] for name in stay},
            origin=base.origin if stay else Origin.COMPUTED,
        ),
    )


def _places(cage: Cage) -> Mapping[str, tuple[str, int]]:
    nodes = {one.name: ("node", one.node) for one in cage.depth_sensors}
    return nodes | {one.name: ("bridle", one.bridle) for one in cage.shackles}


def _level_one(
    cage: Cage, campaign: CampaignRecord, training: Training, report: Progress, total: int
) -> tuple[Models, str]:
    rows = np.flatnonzero(campaign.converged)
    if len(rows) < LEAST_CASES:
        raise InputError(
            f"train: {len(rows)} of the campaign's {len(campaign)} cases converged; at least "
            f"{LEAST_CASES} are needed. Run a larger campaign."
        )
    if campaign.node_position.shape[1] != cage.node_count:
        raise InputError(
            f"train: the campaign's net has {campaign.node_position.shape[1]} nodes, that of "
            f"{cage.name} {cage.node_count}. Give the cage that was simulated."
        )
    water = Metocean.of(campaign.seas).rows(rows)
    x = water.features(training.inputs)
    bridles, kernel = _better_kernel(x, campaign.bridle_tension[rows], training)
    report("train bridles", 1, total)
    shape = ShapeGP(restarts=training.restarts).fit(
        x, campaign.node_position[rows], seed=training.seed
    )
    report("train shape", 2, total)
    still = shape.predict(np.zeros((1, x.shape[1])))
    models = Models(
        cage=cage,
        inputs=training.inputs,
        domain=Domain.of(x),
        edge=_edge(water),
        still_volume=float(cage.volume(still.mean)[0]),
        bridles=bridles,
        shape=shape,
    )
    return models, kernel


def _edge(water: Metocean) -> tuple[float, float]:
    # Rounded up, as a campaign drawn from 0 to 1 m/s stops just short of it.
    speed = float(np.linalg.norm(water.current_velocity, axis=1).max())
    return math.ceil(100.0 * speed) / 100.0, math.ceil(100.0 * float(water.hs.max())) / 100.0


def _better_kernel(
    x: Float[np.ndarray, "case feature"], y: Float[np.ndarray, "case line"], training: Training
) -> tuple[FittedGaussianProcess, str]:
    """Return the process with the higher leave-one-out density, and its kernel's name."""
    # Weighed by spread, as a line that carries little counts no less than one that carries much.
    spread = np.where(np.ptp(y, axis=0) > 0.0, y.std(axis=0), 1.0)
    fitted = [
        GaussianProcess(kernel=kernel, restarts=training.restarts).fit(x, y, seed=training.seed)
        for kernel in KERNELS
    ]
    left_out = [one.leave_one_out() for one in fitted]
    losses = [mnll(y / spread, one.mean / spread, one.std / spread) for one in left_out]
    best = int(np.argmin(losses))
    return fitted[best], KERNELS[best]


def _taught(field: FieldRecord, sensor: str, training: Training) -> Taught | None:
    """Return what a sensor has to teach; None where that is too little."""
    record = field.sensors[sensor]
    window = teaching_window(record, days=training.days, pause_s=training.pause_s)
    if window is None:
        return None
    start, end = window
    if training.choice == "paper":
        pairs = _known(align(field, sensor, start=start, end=end), training.inputs)
        span = PAPER_WINDOW_S[next(iter(record.values))]
        second = (pairs.time - pairs.time[:1]) / np.timedelta64(1, "s")
        most = max(training.high_fidelity_points, PAPER_LEAST)
        rows = window_design(second, span_s=span, least=PAPER_LEAST, most=most)
        pairs = pairs.rows(rows)
        if len(pairs) < PAPER_LEAST:
            return None
        end = _after(pairs)
        lesson = Lesson(start=start, end=end, points=len(pairs))
        return Taught(lesson=lesson, pairs=pairs, chosen=pairs, calibrates=False)
    pairs = align(field, sensor, start=start, end=end, mean_s=training.mean_s)
    pairs = _known(pairs, training.inputs)
    if len(pairs) < LEAST_PAIRS:
        return None
    chosen = _chosen(pairs, training)
    lesson = Lesson(start=start, end=end, points=len(chosen))
    return Taught(lesson=lesson, pairs=pairs, chosen=chosen, calibrates=True)


def _known(pairs: Pairs, inputs: tuple[Input, ...]) -> Pairs:
    return pairs.rows(pairs.metocean.known(inputs))


def _after(pairs: Pairs) -> datetime:
    return moment(pairs.time[-1]) + timedelta(microseconds=1)


def _learned(lessons: Lessons, sensor: str) -> Correction | None:
    """Return level 2 of a sensor, calibrated; None where it says nothing new."""
    taught = lessons.taught.get(sensor)
    if taught is None:
        return None
    model = lessons.learned(sensor, taught.chosen)
    x = taught.chosen.metocean.features(lessons.models.inputs)
    if not model.proven(taught.chosen, lessons.models.lower(sensor).predict(x).mean):
        return None
    return calibrated(model, lessons, sensor) if taught.calibrates else model


def _chosen(pairs: Pairs, training: Training) -> Pairs:
    return spread_out(pairs, training.high_fidelity_points, seed=training.seed)


def _version() -> str:
    from importlib.metadata import version

    return version("seacage")
