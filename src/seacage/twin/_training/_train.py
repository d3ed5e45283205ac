"""Training: level 1 is fitted to simulations, level 2 of each sensor to its readings."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from datetime import timedelta
from importlib.metadata import version
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import InputError, NonsenseError, Origin, Progress, no_progress
from seacage.ocean import over_depth
from seacage.records import CampaignRecord, FieldRecord, bin_keys, current_bins, instant, moment
from seacage.surrogates import (
    Domain,
    FittedGaussianProcess,
    GaussianProcess,
    ShapeGP,
    mnll,
    window_design,
)
from seacage.twin._correction import Correction, CurrentChange
from seacage.twin._lines._site_waves import SiteWaves
from seacage.twin._metocean import Metocean, input_keys
from seacage.twin._models import Models
from seacage.twin._pairs import align, spread_out, training_window
from seacage.twin._profiles import Profiles
from seacage.twin._provenance import Provenance, TrainingWindow
from seacage.twin._training._calibration import calibrate
from seacage.twin._training._data import CageTraining, SensorTraining, Training
from seacage.twin._training._line_levels import train_depth_ratio, train_line_level_2, window_errors
from seacage.twin._training._loads import train_line_loads
from seacage.twin._training._parted import train_parted_lines
from seacage.twin._training._travel_time import fit_travel_time
from seacage.twin._training._windows import sensor_windows
from seacage.twin._travel_time import TravelTime
from seacage.twin._twin import Twin

# For the bridles: the one with kinks, as of lines going slack, and the smooth one
KERNELS = ("matern-5/2", "squared-exponential")

LEAST_CASES = 20  # of a campaign, converged
LEAST_PAIRS = 20  # readings of a sensor
PAPER_WINDOW_S = {"depth_m": 300.0, "tension_kn": 10.0}
# The paper's "few minutes" of a depth sensor and "few seconds" of a shackle [s], whose readings it
# does not count; and the least consecutive readings of slow sensors
PAPER_LEAST = 5
Part = TypeVar("Part")


def train(
    cage: Cage,
    campaign: CampaignRecord | None,
    field: FieldRecord | None = None,
    *,
    parted: Sequence[CampaignRecord] = (),
    base: Twin | None = None,
    training: Training | None = None,
    progress: Progress | None = None,
) -> Twin:
    """Train a twin.

    Level 1 of bridle tensions and shape is fitted to the campaign's converged cases. Level 2
    (NARGP) of each sensor of the field record is then fitted on top: of a shackle to its bridle's
    tension, of a depth sensor to the depth of its node in the reconstructed shape. A sensor
    without enough sound readings, or whose level 2 predicts no better than level 1, stays at
    level 1. The intervals are calibrated on held-out readings: a sensor's own, or for a short
    training window those of sensors with longer ones. How long the current takes from the buoy to
    the cage is found from sensors with at least four days of readings.

    Raises NonsenseError: inputs that the field's buoy or the campaign never had.

    Parameters
    ----------
    cage
        Must be the campaign's; its sensors may have moved.
    campaign
        Of the low fidelity; None with a base.
    field
        None trains level 1 alone.
    parted
        Campaigns of the cage without one line each, in seas and waves of the campaign: what is
        left if a line parts is learned from the pairs.
    base
        A twin of the same cage whose level 1 is taken as it is, and level 2 of every sensor
        that has not moved: only sensors that moved, or are new, are trained.
    training
        Settings; the default suits one buoy and 300 readings of each sensor.
    progress
        Called after each model.
    """
    training = Training() if training is None else training
    _check_inputs(campaign, field, parted, training)
    sensors = [name for name in cage.sensor_names if field and name in field.sensors]

    def report(stage: str, done: int) -> None:
        (progress or no_progress)(f"train {stage}", done, 2 + len(sensors))

    if campaign is not None and base is None:
        level_1 = _level_one(cage, campaign, parted, training, report)
    elif base is not None and campaign is None:
        report("bridles", 1)
        report("shape", 2)
        if parted:
            raise InputError("train: a base has its level 1 already. Give parted with a campaign.")
        level_1 = _from_base(cage, base, training)
    else:
        raise InputError(
            "train: give either a campaign, to fit level 1 to, or a base, whose level 1 is taken."
        )
    if field is None:
        return level_1
    models, provenance = _with_waves(level_1.models, field), level_1.provenance
    travel_time = level_1.travel_time
    # Level 2 that a base has goes by the base's, and the paper's few minutes show none.
    if not models.upper and training.choice != "paper":
        travel_time = fit_travel_time(field, sensors, training)
    models = _with_profiles(models, field, training, travel_time)
    found = {name: _sensor_training(field, name, training, travel_time) for name in sensors}
    data = CageTraining(
        models=models,
        sensors={name: one for name, one in found.items() if one is not None},
        training=training,
    )
    windows = dict(provenance.training_windows)
    for done, name in enumerate(sensors, start=3):
        if name not in level_1.models.upper and (model := _fit_level_2(data, name)) is not None:
            models = models.with_level_2(name, model)
            windows[name] = replace(data.sensors[name].window, calibrated=model.spread.by)
        if name not in {**level_1.models.line_upper, **level_1.models.depth_ratio}:
            models = _with_level_2_in_waves(models, data, field, name, travel_time)
        report(name, done)
    provenance = replace(
        provenance,
        origin=provenance.origin if windows == provenance.training_windows else field.origin,
        hidden_sha256=field.hidden_sha256,
        training_windows=windows,
    )
    buoy = base.buoy if base else field.buoy.stream
    return replace(
        level_1,
        models=models,
        provenance=provenance,
        buoy=buoy,
        travel_time=travel_time,
        current_change=_current_change(level_1, field, windows),
    )


def _current_change(
    base: Twin, field: FieldRecord, windows: Mapping[str, TrainingWindow]
) -> CurrentChange:
    """How the buoy's current changes, until the last training window ends; a base's own stays."""
    if base.models.upper or not windows:
        return base.current_change
    until = instant(max(one.end for one in windows.values()))
    return CurrentChange.of_buoy(field.buoy.rows(field.buoy.time < until))


def _with_waves(models: Models, field: FieldRecord) -> Models:
    """Models whose loads of lines have the site's waves from its record, if it has any."""
    origin = f"the waves in the record of {field.buoy.stream}"
    waves = SiteWaves.of(Metocean.of_record(field.buoy), origin)
    if models.loads is None or waves is None:
        return models
    return replace(models, loads=replace(models.loads, waves=waves))


def _with_profiles(
    models: Models, field: FieldRecord, training: Training, travel_time: TravelTime
) -> Models:
    """Models whose profiles are those of the field's training window, where it has enough."""
    if "profile" not in models.inputs or len(field.buoy) == 0:
        return models
    time = field.buoy.time
    time = time[time < time[0] + np.timedelta64(round(86400.0 * training.days), "s")]
    profiles = Profiles.of_water(travel_time.water_at(field.buoy, time))
    return models if profiles is None else replace(models, profiles=profiles)


def _check_inputs(
    campaign: CampaignRecord | None,
    field: FieldRecord | None,
    parted: Sequence[CampaignRecord],
    training: Training,
) -> None:
    if campaign is not None and campaign.parted:
        raise InputError(
            f"train: the campaign is of a cage without {', '.join(campaign.parted)}. Give that of "
            "the whole cage, and this one as parted."
        )
    if parted and campaign is not None and campaign.simulator:
        raise InputError(
            "train: what is left if a line parts is learned from pairs of seacage's own "
            f"simulations, and the campaign is of {campaign.simulator}. Leave parted out."
        )
    for key in input_keys(training.inputs):
        if field and not (key in field.buoy.values and np.any(field.buoy.usable(key))):
            raise NonsenseError(
                f"train: {field.buoy.stream} has no {key}, which the inputs "
                f"{','.join(training.inputs)} ask for. Train with what it has."
            )
    if campaign and "waves" in training.inputs and not any(sea.hs for sea in campaign.seas):
        raise NonsenseError(
            "train: the campaign has no waves, which the inputs ask for. Simulate one with waves."
        )
    if "profile" not in training.inputs:
        return
    if campaign and not any(sea.current_shear for sea in campaign.seas):
        raise NonsenseError(
            "train: the currents of the campaign do not change with depth, and the inputs ask for "
            "a profile. Simulate one with `--plan profile`."
        )
    if field and len(current_bins(field.buoy.values)) < 2:
        raise NonsenseError(
            f"train: {field.buoy.stream} has the current at fewer than two depths, and the inputs "
            f"ask for a profile. Give it keys such as {' and '.join(bin_keys(5.0))}."
        )


def update(twin: Twin, field: FieldRecord, *, points: int = 60, mean_s: float = 60.0) -> Twin:
    """Condition level 2 on readings since the training windows, without fitting again.

    The hyperparameters, the gain and the calibration of each sensor stay, and level 1 is not
    touched. Every reading makes the twin a little slower: where they have doubled, train again.

    Parameters
    ----------
    twin
        With level 2 of some sensors.
    field
        Has later readings of some of them.
    points
        Readings of each sensor that are taken in, at most, spread over currents and time.
    mean_s
        Time over which readings are averaged, as in the training [s].
    """
    models, windows = twin.models, dict(twin.provenance.training_windows)
    for name, model in twin.models.upper.items():
        if name not in field.sensors:
            continue
        pairs = align(
            field, name, start=windows[name].end, mean_s=mean_s, travel_time=twin.travel_time
        )
        pairs = pairs.through(models.inputs)
        if len(pairs) == 0:
            continue
        end = moment(pairs.time[-1]) + timedelta(seconds=mean_s)
        pairs = spread_out(pairs, points, seed=twin.provenance.seed)
        x = pairs.metocean.features(models.inputs)
        models = models.with_level_2(name, model.updated(pairs, x))
        window = windows[name]
        windows[name] = replace(window, end=end, points=window.points + len(pairs))
    return replace(
        twin, models=models, provenance=replace(twin.provenance, training_windows=windows)
    )


def _from_base(cage: Cage, base: Twin, training: Training) -> Twin:
    """Take level 1, and level 2 of the sensors that have not moved."""
    before = base.cage
    if replace(cage, shackle=before.shackle, depth_sensor=before.depth_sensor) != before:
        raise InputError(
            f"train: {cage.name} differs from the base's cage by more than its sensors. Simulate "
            "it and give the campaign."
        )
    if training.inputs != base.models.inputs:
        raise InputError(
            f"train: the inputs of the base are {' and '.join(base.models.inputs)}, not "
            f"{' and '.join(training.inputs)}. Give the same, or give a campaign."
        )
    places = (*before.depth_sensors, *before.shackles)
    unmoved = {one.name for one in (*cage.depth_sensors, *cage.shackles) if one in places}

    def stay(parts: Mapping[str, Part]) -> dict[str, Part]:
        return {name: one for name, one in parts.items() if name in unmoved}

    models, provenance = base.models, base.provenance
    upper = stay(models.upper)
    return replace(
        base,
        models=replace(
            models,
            cage=cage,
            upper=upper,
            line_upper=stay(models.line_upper),
            depth_ratio=stay(models.depth_ratio),
            line_errors=stay(models.line_errors),
        ),
        provenance=replace(
            provenance,
            training_windows={name: provenance.training_windows[name] for name in upper},
            origin=base.origin if upper else Origin.COMPUTED,
            seed=training.seed,
        ),
    )


def _level_one(
    cage: Cage,
    campaign: CampaignRecord,
    parted: Sequence[CampaignRecord],
    training: Training,
    report: Callable[[str, int], None],
) -> Twin:
    """Fit level 1 to the cases of a campaign that converged."""
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
    # Rounded up, as a campaign drawn from 0 to 1 m/s stops just short of it.
    largest = np.linalg.norm(water.current_velocity, axis=1).max(), water.hs.max()
    speed, hs = (math.ceil(100.0 * float(one)) / 100.0 for one in largest)
    bridles, kernel = _better_kernel(x, campaign.bridle_tension[rows], training)
    report("bridles", 1)
    shape = ShapeGP(restarts=training.restarts).fit(
        x, campaign.node_position[rows], seed=training.seed
    )
    report("shape", 2)
    still = shape.predict(np.zeros((1, x.shape[1])))
    still_volume = float(cage.volume(still.mean)[0])
    searches = {"restarts": min(training.restarts, 1), "seed": training.seed}
    loads = train_line_loads(cage, campaign, **searches)
    damaged = None
    if parted:
        if loads is None:
            raise InputError(
                "train: the campaign teaches no loads in waves, so what changes in them if a line "
                "parts cannot be learned. Simulate it by `--plan loads`."
            )
        damaged = train_parted_lines(cage, campaign, parted, still_volume=still_volume, **searches)
    models = Models(
        cage=cage,
        inputs=training.inputs,
        domain=Domain.of(x),
        edge=(speed, hs),
        still_volume=still_volume,
        bridles=bridles,
        shape=shape,
        profiles=_profiles_of_campaign(water) if "profile" in training.inputs else None,
        loads=loads,
        parted=damaged,
    )
    provenance = Provenance(
        version=version("seacage"),
        law=campaign.law,
        campaign_seed=campaign.seed,
        campaign_sha256=campaign.sha256,
        cases=len(rows),
        physics=campaign.physics,
        kernel=kernel,
        origin=Origin.COMPUTED,
        hidden_sha256=None,
        seed=training.seed,
    )
    return Twin(models=models, provenance=provenance)


def _profiles_of_campaign(water: Metocean) -> Profiles:
    """Profiles of a campaign over their currents at the surface."""
    assert water.profile is not None
    surface = over_depth(water.profile[:, :2], water.profile[:, 2:], np.zeros(1))[:, 0]
    return Profiles.of(surface, water.profile)


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


def _sensor_training(
    field: FieldRecord, sensor: str, training: Training, travel_time: TravelTime
) -> SensorTraining | None:
    """Return a sensor's training data; None where that is too little."""
    record = field.sensors[sensor]
    window = training_window(record, days=training.days, pause_s=training.pause_s)
    if window is None:
        return None
    (start, end), paper = window, training.choice == "paper"
    mean_s = None if paper else training.mean_s
    pairs = align(field, sensor, start=start, end=end, mean_s=mean_s, travel_time=travel_time)
    pairs = pairs.through(training.inputs)
    if paper:
        span = PAPER_WINDOW_S[next(iter(record.values))]
        second = (pairs.time - pairs.time[:1]) / np.timedelta64(1, "s")
        most = max(training.high_fidelity_points, PAPER_LEAST)
        rows = window_design(second, span_s=span, least=PAPER_LEAST, most=most)
        pairs = pairs.rows(rows)
    if len(pairs) < (PAPER_LEAST if paper else LEAST_PAIRS):
        return None
    selected = pairs if paper else training.select(pairs)
    end = moment(pairs.time[-1]) + timedelta(microseconds=1) if paper else end
    own = TrainingWindow(start=start, end=end, points=len(selected))
    return SensorTraining(window=own, pairs=pairs, selected=selected, calibrates=not paper)


def _fit_level_2(data: CageTraining, sensor: str) -> Correction | None:
    """Fit and calibrate level 2 of a sensor; None where it is no better than level 1."""
    own = data.sensors.get(sensor)
    if own is None:
        return None
    model = data.fit(sensor, own.selected)
    level_1 = data.models.lower(sensor).predict(data.features(own.selected))
    if not model.beats_level_1(own.selected, level_1.mean):
        return None
    return calibrate(model, data, sensor) if own.calibrates else model


def _with_level_2_in_waves(
    models: Models, data: CageTraining, field: FieldRecord, sensor: str, travel_time: TravelTime
) -> Models:
    """Return models with level 2 in waves, if it shows a gain: of a shackle's line, or a depth."""
    own, bridles = data.sensors.get(sensor), {one.name: one.bridle for one in models.cage.shackles}
    if models.loads is None or own is None:
        return models
    windows = sensor_windows(
        align(field, sensor, start=own.window.start, end=own.window.end, travel_time=travel_time),
        noise_sd=data.training.noise_sd.get(sensor),
        tn_slope=models.cage.bridles.tn_slope or math.nan,
    )
    if windows is None:
        return models
    windows = replace(windows, metocean=windows.metocean.through(models.inputs))
    windows = windows.rows(windows.metocean.known(models.inputs))
    if sensor not in bridles:
        windows = windows.rows(models.loads.hold(windows.metocean).inside)
        low = models.depth_std(windows.metocean, models.loads.node_motion(windows.metocean))
        ratio = train_depth_ratio(low[:, models.cage.sensor_names.index(sensor)], windows)
        own_ratio = {} if ratio is None else {sensor: ratio}
        return replace(models, depth_ratio={**models.depth_ratio, **own_ratio})
    loads, line = models.loads, bridles[sensor]
    off = window_errors(loads, line, windows)
    if off is not None:
        models = replace(models, line_errors={**models.line_errors, sensor: off})
    found = train_line_level_2(
        loads,
        line,
        windows,
        model=models.upper.get(sensor),
        selected=own.selected,
        x=windows.metocean.features(models.inputs),
    )
    if found is None:
        return models
    return replace(models, line_upper={**models.line_upper, sensor: found})
