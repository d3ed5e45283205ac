"""Loads of shackled lines in waves on held-out days: both fidelities and simple baselines."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns import Plan
from seacage.conventions import InputError, Origin
from seacage.records import CampaignRecord, FieldRecord, read_campaign
from seacage.studies._chain import TRAINING, Chain
from seacage.studies._demonstration_field import SEED, TRAINING_DAYS, read_demonstration_field
from seacage.studies._interval import Interval, by_day
from seacage.studies._paper._boosted_trees import predict_by_trees
from seacage.studies._split import split
from seacage.surrogates import Loads, sea_features
from seacage.twin import Metocean, Twin, Windows, align, sensor_windows, train

LEVEL_1, LEVEL_2 = "level 1", "level 2"
BASELINES = ("sensor alone", "gain and offset", "linear", "boosted trees")
METHODS = (LEVEL_2, LEVEL_1, *BASELINES)
# Fields of ``Windows``, and the words for them
STATISTICS = {
    "mean": "mean",
    "std": "standard deviation",
    "maximum": "largest value",
    "damage": "damage-equivalent load",
}
LEAST_WINDOWS = 12  # on either side of the cut: two hours
MOST_ERROR = 1.0  # more counts as much, as a line that hangs slack has any relative error [-]
WINDOW_SHARE = 600.0 / 10800.0  # of the time that ``maximum_3h`` is of [-]

Series = Float[np.ndarray, " window"]
HeldOut = Float[np.ndarray, " held_out"]


@dataclass(frozen=True, slots=True, kw_only=True)
class WaveLoadScore:
    """Errors of one statistic of a shackle's ten-minute windows on held-out days."""

    sensor: str
    statistic: str
    origin: Origin  # of the readings
    # Between the readings [s], and how many fall on a peak period at the median [-]
    every_s: float
    peak_samples: float
    # Numbers of windows that are fitted to and held out
    training_windows: int
    windows: int
    corrected: bool  # whether level 2 differs from level 1 at all
    error: Mapping[str, float]  # median error over the reading, by method [-]
    # Mean error of each other method less that of level 2, errors above 1 as 1 [-]
    gain: Mapping[str, Interval]
    coverage: float | None  # of level 2's 95 % interval; None where it has none [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class WaveLoads:
    """The section of the study on loads in waves."""

    own_field: bool  # of the study, else the demonstration's
    cases: int = 0  # that level 1 learned from; 0 where the field is of another cage
    sensors: tuple[str, ...] = ()  # all shackles
    scores: tuple[WaveLoadScore, ...] = ()


def wave_loads(chain: Chain, *, cases: int, given: Path | None = None) -> WaveLoads:
    """Train a twin of loads in waves and score it, making the stages that are missing.

    The field is the chain's own where its buoy has waves with their periods, else the
    demonstration's, which is of the shipped cage.

    ``cases``: of a campaign made here. ``given``: a finished campaign of plan ``loads``.
    """
    field, days = chain.field, chain.recipe.teaching_days
    own = {"hs_m", "tp_s", "wave_from_deg"} <= set(field.buoy.values)
    if not own:
        field, days = read_demonstration_field(), TRAINING_DAYS
        if chain.cage != Cage.named(field.cage):
            return WaveLoads(own_field=False)
    teaching, held_out = split(field, teaching_days=days)
    campaign = _campaign(chain, cases, given)
    training = replace(chain.recipe.training, days=float(days), pause_s=86400.0 * days)

    def make(begun: Path) -> None:
        twin = train(chain.cage, campaign, teaching, training=training, progress=chain.progress)
        twin.write(begun / "twin")

    settings = {
        "cage": chain.cage.to_toml(),
        "campaign_sha256": campaign.sha256,
        "field_sha256": [one.sha256 for one in (teaching.buoy, *teaching.sensors.values())],
        "training": asdict(training),
    }
    folder = chain.stages.ensure("loads-twin", settings, make, rooms=TRAINING)
    twin = Twin.read(folder / "twin")
    return WaveLoads(
        own_field=own,
        cases=twin.provenance.cases,
        sensors=tuple(one.name for one in twin.cage.shackles),
        scores=score_wave_loads(twin, teaching, held_out, seed=chain.recipe.seed),
    )


def score_wave_loads(
    twin: Twin, teaching: FieldRecord, held_out: FieldRecord, *, seed: int
) -> tuple[WaveLoadScore, ...]:
    """Score each statistic of each shackle that has enough windows with it on both sides.

    ``teaching``, ``held_out``: the days. ``seed``: of the bootstrap.

    Raises InputError: the twin has no loads in waves.
    """
    if twin.emulator is None:
        raise InputError(
            "study paper: the campaign for loads teaches none in waves. Give one that `seacage "
            "campaign run --plan loads` made."
        )
    scores = list[WaveLoadScore]()
    slope = twin.cage.bridles.tn_slope or math.nan
    for shackle in twin.cage.shackles:
        parts = [
            sensor_windows(align(one, shackle.name, travel_time=twin.travel_time), tn_slope=slope)
            for one in (teaching, held_out)
            if shackle.name in one.sensors
        ]
        windows = [
            one.rows(twin.predict(one.metocean).line_in_domain) for one in parts if one is not None
        ]
        for name in STATISTICS:
            found = [one.rows(getattr(one, name) > 0.0) for one in windows]
            if len(found) == 2 and min(map(len, found)) >= LEAST_WINDOWS:
                scores.append(_score(twin, shackle.name, shackle.bridle, name, *found, seed=seed))
    return tuple(scores)


def _score(
    twin: Twin, sensor: str, line: int, name: str, before: Windows, after: Windows, *, seed: int
) -> WaveLoadScore:
    loads, emulator, reading = (
        twin.predict(after.metocean).line,
        twin.emulator,
        getattr(after, name),
    )
    assert loads is not None
    assert emulator is not None
    low, there = (
        predict_statistic(emulator.predict(one.metocean, spread=False)[0], name, line)[0]
        for one in (before, after)
    )
    best, lower, upper = predict_statistic(loads, name, line)
    corrected = not np.allclose(best, there)
    found = {LEVEL_2: best if corrected else there, LEVEL_1: there}
    found |= predict_by_baselines(name, before, after, low=low, there=there)
    error = {method: np.abs(found[method] - reading) / reading for method in METHODS}
    bound = {method: np.minimum(one, MOST_ERROR) for method, one in error.items()}
    return WaveLoadScore(
        sensor=sensor,
        statistic=STATISTICS[name],
        origin=Origin.VIRTUAL_FIELD,
        every_s=after.every_s,
        peak_samples=min(float(np.median(one.peak_samples)) for one in (before, after)),
        training_windows=len(before),
        windows=len(after),
        corrected=corrected,
        error={method: float(np.median(one)) for method, one in error.items()},
        gain={
            method: by_day(bound[method] - bound[LEVEL_2], after.number // 144, seed=seed)
            for method in METHODS[1:]
        },
        coverage=float(np.mean((lower <= reading) & (reading <= upper)))
        if np.isfinite(upper).all()
        else None,
    )


def predict_by_baselines(
    name: str, before: Windows, after: Windows, *, low: Series, there: HeldOut
) -> dict[str, HeldOut]:
    """Predictions by simple baselines of a statistic of ``after``, fitted to ``before``.

    All on the scale that level 2 learns on: the tension of a mean, else the logarithm.

    ``low``, ``there``: level 1 at both [N].
    """
    to, back = (np.asarray, np.asarray) if name == "mean" else (np.log, np.exp)
    target, low, there = (to(np.maximum(one, 1.0)) for one in (getattr(before, name), low, there))
    trees, at_trees = (
        sea_features(sea.current_velocity, hs=sea.hs, tp=sea.tp, wave_direction=sea.wave_direction)
        for sea in (before.metocean, after.metocean)
    )
    found = (
        np.full(len(after), np.median(target)),
        np.polyval(np.polyfit(low, target, 1), there),
        regress_on_sea(before.metocean, target, after.metocean),
        predict_by_trees(trees, target, at_trees),
    )
    return {method: np.asarray(back(one)) for method, one in zip(BASELINES, found, strict=True)}


def regress_on_sea(water: Metocean, value: Series, at: Metocean) -> HeldOut:
    """Values in other water, by least squares on the current, log Hs and log Tp."""
    # Few features for a line: through some hours of all of them it leads anywhere.
    line, there = (
        np.column_stack([np.ones(len(sea)), np.log(sea.hs), np.log(sea.tp), sea.current_velocity])
        for sea in (water, at)
    )
    return there @ np.linalg.lstsq(line, value, rcond=None)[0]


def predict_statistic(loads: Loads, name: str, line: int) -> tuple[Series, Series, Series]:
    """Mean of a statistic of ten minutes, and the ends of its 95 % interval [N]."""
    if name == "mean":
        mean, half = loads.mean.mean[:, line], 1.96 * loads.mean.std[:, line]
        return mean, mean - half, mean + half
    parts = {"std": loads.std, "maximum": loads.maximum_3h, "damage": loads.damage_equivalent}
    load = parts[name].lines(np.array([line]))
    if name == "maximum":
        load = load.of_share(WINDOW_SHARE)
    lower, upper = load.interval(0.95)
    return load.mean[:, 0], lower[:, 0], upper[:, 0]


def _campaign(chain: Chain, cases: int, given: Path | None) -> CampaignRecord:
    if given is not None:
        campaign = read_campaign(given)
        if campaign.cage_toml == chain.cage.to_toml():
            return campaign
        raise InputError(
            f"study paper: {given} is a campaign of another cage than {chain.cage.name}. Give one "
            "that `seacage campaign run --plan loads` made of this cage."
        )
    return chain.stages.ensure_campaign(
        "loads",
        chain.cage,
        Plan.named("loads", SEED, cases, duration=900.0),
        method="simulate",
        spin_up=200.0,
    )
