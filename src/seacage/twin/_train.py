"""Training: the simulations teach level 1, each sensor teaches its own level 2."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, Origin, Progress
from seacage.records import CampaignRecord, FieldRecord
from seacage.surrogates import (
    Domain,
    FittedGaussianProcess,
    GaussianProcess,
    ShapeGP,
    mnll,
)
from seacage.twin._align import Pairs, align, spread_out, teaching_window
from seacage.twin._correction import Correction
from seacage.twin._metocean import Input, Metocean
from seacage.twin._models import Models
from seacage.twin._provenance import Lesson, Provenance
from seacage.twin._twin import Twin

KERNELS = ("matern-5/2", "squared-exponential")
"""For the bridles: the one with kinks, as of lines going slack, and the smooth one."""

LEAST_CASES = 20
LEAST_PAIRS = 20
"""Fewer than these say nothing about a cage."""


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
        ``"spread"`` over currents and time, or ``"paper"``: so many in a row from the first
        on, which teaches the noise of one hour and too narrow intervals.
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
    campaign: CampaignRecord,
    field: FieldRecord | None = None,
    *,
    training: Training | None = None,
    progress: Progress | None = None,
) -> Twin:
    """Train a twin.

    Level 1 learns bridle tensions and shape from the campaign's converged cases. Each sensor
    of the field record then teaches its own level 2 (NARGP) on top: a shackle on its bridle's
    tension, a depth sensor on the depth of its node in the reconstructed shape. A sensor
    without enough sound readings, or whose readings level 1 meets as well as what they taught,
    stays at level 1.

    Parameters
    ----------
    cage
        Must be the campaign's; its sensors may have moved.
    campaign
        Of the low fidelity.
    field
        None trains level 1 alone.
    training
        What to learn from; the default suits one buoy and 300 readings of each sensor.
    progress
        Called after each model.
    """
    training = Training() if training is None else training
    report: Progress = progress or (lambda _stage, _done, _total: None)
    sensors = [name for name in cage.sensor_names if field and name in field.sensors]
    total = 2 + len(sensors)

    models, kernel = _level_one(cage, campaign, training, report, total)
    lessons: dict[str, Lesson] = {}
    for done, name in enumerate(sensors, start=3):
        assert field is not None
        learned = _learned(models, field, name, training)
        if learned is not None:
            lessons[name], model = learned
            models = models.taught(name, model)
        report(f"train {name}", done, total)
    provenance = Provenance(
        version=_version(),
        law=campaign.law,
        campaign_seed=campaign.seed,
        campaign_sha256=campaign.sha256,
        cases=int(np.sum(campaign.converged)),
        kernel=kernel,
        origin=field.origin if field and lessons else Origin.COMPUTED,
        hidden_sha256=field.hidden_sha256 if field else None,
        seed=training.seed,
        lessons=lessons,
    )
    return Twin(models=models, provenance=provenance, buoy=field.buoy.stream if field else "buoy-1")


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


def _learned(
    models: Models, field: FieldRecord, sensor: str, training: Training
) -> tuple[Lesson, Correction] | None:
    """Return what a sensor taught, and level 2 of it; None where it says nothing new."""
    window = teaching_window(field.sensors[sensor], days=training.days, pause_s=training.pause_s)
    if window is None:
        return None
    start, end = window
    pairs = align(field, sensor, start=start, end=end, mean_s=training.mean_s)
    pairs = pairs.rows(pairs.metocean.known(training.inputs))
    if len(pairs) < LEAST_PAIRS:
        return None
    pairs = _chosen(pairs, training)
    x = pairs.metocean.features(training.inputs)
    model = Correction.learned(
        pairs,
        x,
        models.lower(sensor),
        restarts=training.restarts,
        seed=training.seed,
    )
    if not model.proven(pairs, models.lower(sensor).predict(x).mean):
        return None
    return Lesson(start=start, end=end, points=len(pairs)), model


def _chosen(pairs: Pairs, training: Training) -> Pairs:
    count = training.high_fidelity_points
    if training.choice == "paper":
        return pairs.rows(np.arange(min(count, len(pairs))))
    return spread_out(pairs, count, seed=training.seed)


def _version() -> str:
    from importlib.metadata import version

    return version("seacage")
