"""Virtual fields in waves whose sensors never fall silent.

``in_waves`` gives a year of a settled field waves, by some sixty hours that are simulated. Waves,
inertia and the profile of the current add to a sensor's mean what its settled equilibrium
lacks. That is found in hours spread over the year, simulated in time, and a Gaussian process of
current, waves and growth says it for all other times. What the process cannot say, hour by hour,
is added by chance, and so is the pressure of the air.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
from _family_fields import START
from jaxtyping import Float, Shaped

from seacage.cage import Cage
from seacage.campaigns import Timetable, TruthParameters, generated_waves, virtual_field
from seacage.campaigns._virtual_field._field import _current_over_net
from seacage.campaigns._virtual_field._responses import true_responses
from seacage.campaigns._virtual_field._sensors import air_pressure, sense
from seacage.campaigns._virtual_field._simulated import _with_waves
from seacage.records import FieldRecord, Record, TrueMeans
from seacage.surrogates import GaussianProcess, block_means, current_features, wave_features
from seacage.twin import Metocean, TravelTime

SIMULATED = 60  # hours of the record
EVERY = 4.0  # between readings of those [s]
MEAN = 600  # length of means [s]
HOUR, DAY = 3600.0, 86400.0


def in_waves(
    cage: Cage, field: FieldRecord, *, hidden: TruthParameters, seed: int, kept: Path
) -> FieldRecord:
    """Add waves to a settled field, and print how well it is known what they add.

    ``field``: of ``virtual_field`` with this cage, truth, seed and folder of what is kept.
    """
    time = next(iter(field.sensors.values())).time
    days = float((time[-1] - time[0]) / np.timedelta64(1, "D"))
    waves = generated_waves(seed, start=START, days=days + 1.0)
    answers, _ = true_responses(cage, hidden, store=kept, workers=1)
    means = _simulated(cage, field.buoy, waves, hidden=hidden, seed=seed, kept=kept / "in waves")
    velocity = _over_net(means)
    added = _readings(cage, means) - answers.at(velocity, means.growth)
    x = _features(velocity, means.growth, waves, means.time)
    # An hour's means are alike, so that hours are held out whole.
    hour = np.cumsum(np.diff(means.time, prepend=means.time[:1]) > np.timedelta64(3600, "s"))
    held = hour % 5 == 4
    process = GaussianProcess(restarts=1)
    left = added[held] - process.fit(x[~held], added[~held]).predict(x[held]).mean
    for name, whole, rest in zip(field.sensors, added[held].T, left.T, strict=True):
        said = f"{whole.mean():.2f} more in waves, give or take {whole.std():.2f}"
        print(f"{hidden.title} {name}: {said}, of which {rest.std():.2f} is left")
    seconds = (time - field.buoy.time[0]) / np.timedelta64(1, "s")
    at_cage = _current_over_net(field.buoy, seconds, hidden=hidden, seed=seed)
    everywhere = _features(at_cage, hidden.fouling.grown(seconds / DAY), waves, time)
    fitted = process.fit(x, added)
    chunks = [slice(first, first + 2000) for first in range(0, len(time), 2000)]
    by_waves = np.concatenate([fitted.predict(everywhere[rows]).mean for rows in chunks])
    rng = np.random.default_rng([seed, *b"in waves"])
    hours = (seconds // HOUR).astype(int)
    by_waves += (left.std(axis=0) * rng.normal(size=(hours[-1] + 1, by_waves.shape[1])))[hours]
    depths = len(cage.depth_sensors)
    by_waves[:, :depths] += hidden.depth.m_per_hpa * air_pressure(hidden, time, rng)[:, None]
    sensors = {
        name: replace(one, values={key: np.maximum(column + extra, np.minimum(column, 0.0))})
        for extra, (name, one) in zip(by_waves.T, field.sensors.items(), strict=True)
        for key, column in one.values.items()
    }
    return replace(field, buoy=_with_waves(field.buoy, waves), sensors=sensors)


def simulated(folder: Path, *, hidden: TruthParameters, seed: int) -> FieldRecord:
    """Read a field that was simulated in time, as means of ten minutes of sensors that never fail.

    ``hidden``: of the field, without outages. ``seed``: of the field; gains and biases are its own.
    """
    field, truth = FieldRecord.read(folder), FieldRecord.read(folder / "truth")
    rng = np.random.default_rng([seed, *b"sensors"])
    _, air, _, *own = rng.spawn(3 + len(truth.sensors))
    pressure = air_pressure(hidden, next(iter(truth.sensors.values())).time, air)
    sensors = {
        name: _means_of(sense(one, hidden, chance, pressure=pressure))
        for (name, one), chance in zip(truth.sensors.items(), own, strict=True)
    }
    return replace(field, sensors=sensors)


def _means_of(sensor: Record) -> Record:
    second = sensor.time.astype("datetime64[s]").astype(np.int64)
    window, means = block_means(second // MEAN, *sensor.values.values())
    time = (window * MEAN + MEAN // 2).astype("datetime64[s]").astype(sensor.time.dtype)
    return replace(sensor, time=time, values=dict(zip(sensor.values, means, strict=True)), flags={})


def _simulated(
    cage: Cage, buoy: Record, waves: Record, *, hidden: TruthParameters, seed: int, kept: Path
) -> TrueMeans:
    """Means of ten minutes of the cage in waves, of hours spread over the record."""
    hidden = replace(
        hidden,
        netting=replace(hidden.netting, refined=1),
        shackle=replace(hidden.shackle, windows=()),
    )
    timetable = Timetable.over(buoy, refined=1)
    stretches = (buoy.time[-1] - buoy.time[0]) / np.timedelta64(round(timetable.stretch), "s")
    means = virtual_field(
        cage,
        buoy,
        hidden=hidden,
        seed=seed,
        waves=waves,
        every_s=EVERY,
        timetable=replace(timetable, one_in=max(1, round(stretches / SIMULATED))),
        kept=kept,
        workers=1,
    ).means
    assert means is not None
    return means


def _over_net(means: TrueMeans) -> Float[np.ndarray, "mean 2"]:
    """Current over the depths of the levels, averaged [m/s]."""
    depth = means.level_depth
    return np.trapezoid(means.current_velocity, depth, axis=1) / (depth[-1] - depth[0])


def _readings(cage: Cage, means: TrueMeans) -> Float[np.ndarray, "mean sensor"]:
    """What the sensors would read without error [m] or [kN]."""
    nodes = [one.node for one in cage.depth_sensors]
    bridles = [one.bridle for one in cage.shackles]
    return np.hstack(
        [-means.node_position[:, nodes, 2], means.bridle_tension_mean[:, bridles] / 1e3]
    )


def _features(
    velocity: Float[np.ndarray, "t 2"],
    growth: Float[np.ndarray, " t"],
    waves: Record,
    time: Shaped[np.ndarray, " t"],
) -> Float[np.ndarray, "t feature"]:
    water: Metocean = TravelTime().water_at(waves, time)
    by_waves = wave_features(water.hs, water.wave_direction, tp=water.tp)
    return np.hstack([current_features(velocity), by_waves, growth[:, None]])
