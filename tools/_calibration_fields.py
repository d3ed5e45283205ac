"""What a trained twin answers on fields of the family's cages, beside the truth, as arrays."""

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Literal

import numpy as np
from _family_fields import START, field_of, scored_times, values_at
from score_net import true_nets

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, VirtualField
from seacage.records import Record
from seacage.surrogates import AdaptiveConformal
from seacage.twin import Metocean, Training, Twin, train

EXTRA = "extra-"
"""Before the names of the shackles that the twin does not see."""
AGES_MIN = (0.0, 10.0, 30.0, 60.0)  # of the buoy's newest sample
NODE_TIMES, NODES = 12, 8  # every twelfth half hour, and every eighth node
MINUTE, DAY = np.timedelta64(60, "s"), np.timedelta64(86400, "s")
# Growth that begins where the depth sensors' training ends, is half done ten days later, and is
# never cleaned
HEAVY = {"age_days": 0.0, "cleaned_days": (), "half_grown_days": 35.0, "growth_days": 4.0}
Water = Literal["tame", "coastal"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answers:
    """Of one field: the truth, means and standard deviations, with the age of the input first."""

    day: np.ndarray  # of the field, (time)
    velocity: np.ndarray  # of the current at the cage by the twin [m/s], (age, time, 2)
    growth: np.ndarray  # true [-], (time)
    factor: np.ndarray  # online, of the depth sensors, (time, depth)
    trained: np.ndarray  # day on which each sensor's training ended; NaN without level 2
    fastest: np.ndarray  # current in each sensor's training [m/s]
    true: np.ndarray  # readings without errors, (time, sensor)
    mean: np.ndarray  # (age, time, sensor)
    std: np.ndarray
    steepness: np.ndarray  # of each sensor's level 1 over the current, (age, time, sensor)
    bridle_true: np.ndarray  # (time, line)
    bridle_mean: np.ndarray  # (age, time, line)
    bridle_std: np.ndarray
    bridle_level: np.ndarray
    node_true: np.ndarray  # at every twelfth time, (time, node, 3)
    node_mean: np.ndarray
    node_std: np.ndarray
    node_size: np.ndarray  # displacement from still water [m], (time, node)
    volume: np.ndarray  # true, mean, standard deviation, (3, time)
    buoy_change: np.ndarray  # sd of a component's change in 6, 12, 30, 60 and 120 min [m/s]

    @classmethod
    def read(cls, path: Path) -> "Answers":
        """Read what ``write`` wrote."""
        with np.load(path) as stored:
            return cls(**stored)

    def write(self, path: Path) -> None:
        """Keep the arrays."""
        np.savez_compressed(path, **{one.name: getattr(self, one.name) for one in fields(self)})


def with_every_shackle(cage: Cage) -> Cage:
    """Return the cage with a shackle on every bridle."""
    seen = {one.bridle for one in cage.shackle}
    others = (k for k in range(1, cage.bridle_count + 1) if k not in seen)
    extra = (replace(cage.shackle[0], name=f"{EXTRA}{k}", bridle=k) for k in others)
    return replace(cage, shackle=(*cage.shackle, *extra))


def answers_of(
    base: Twin, number: int, given: argparse.Namespace, *, heavy: bool = False
) -> Answers:
    """Train on one field, and answer; kept in the output folder."""
    water: Water = "tame" if number % 2 else "coastal"
    kept = given.out / f"truth-{number}{'-heavy' * heavy}.npz"
    if not kept.is_file():
        hidden = TruthParameters.of_family(number, water=water, unseal=given.unseal)
        if heavy:
            hidden = replace(hidden, fouling=replace(hidden.fouling, **HEAVY))
        full, folder = with_every_shackle(base.cage), f"truth-{number}"
        field = field_of(full, number, water, given, name=folder, hidden=hidden)
        record = field.record
        seen = {k: one for k, one in record.sensors.items() if not k.startswith(EXTRA)}
        record = replace(record, sensors=seen)
        twin = train(base.cage, None, record, base=base, training=Training(restarts=1))
        twin.write(kept.with_suffix(".twin"))
        nets = scored_times(field.truth.buoy)[::NODE_TIMES]
        net = true_nets(full, hidden, field.truth.buoy, number, nets, given.out / folder)
        _answers(twin, replace(field, record=record), full, hidden, net).write(kept)
    return Answers.read(kept)


def _answers(
    twin: Twin, field: VirtualField, full: Cage, hidden: TruthParameters, net: np.ndarray
) -> Answers:
    buoy, truth = field.record.buoy, field.truth
    time = scored_times(buoy)
    waters = [held_water(twin, buoy, time, age) for age in AGES_MIN]
    every = [twin.predict(one).without_nodes() for one in waters]
    at_nets = twin.predict(waters[0].rows(np.arange(0, len(time), NODE_TIMES)))
    day = (time - np.datetime64(START.replace(tzinfo=None))) / DAY
    windows = twin.provenance.training_windows
    trained, fastest = np.full((2, len(twin.sensor_names)), np.nan)
    for column, model in twin.models.corrections.items():
        end = windows[twin.sensor_names[column]].end
        trained[column] = (end - START).total_seconds() / 86400.0
        fastest[column] = model.domain.upper[0]
    bridle_true = np.full((len(time), full.bridle_count), np.nan)
    for shackle in full.shackles:
        bridle_true[:, shackle.bridle] = values_at(truth.sensors[shackle.name], time)
    still = twin.models.net.still if twin.models.net else at_nets.node_position[0]
    mean = at_nets.node_position
    volume = [full.volume(net) / twin.models.still_volume]
    volume += [at_nets.volume_fraction, at_nets.volume_std]
    return Answers(
        day=day,
        velocity=np.stack([one.current_velocity for one in waters]),
        growth=hidden.fouling.grown(day),
        factor=_factors(twin, field, time),
        trained=trained,
        fastest=fastest,
        true=np.stack([values_at(truth.sensors[k], time) for k in twin.sensor_names], axis=1),
        mean=np.stack([one.sensor.mean for one in every]),
        std=np.stack([one.sensor.std for one in every]),
        steepness=np.stack([twin.models.steepness(one) for one in waters]),
        bridle_true=bridle_true,
        bridle_mean=np.stack([one.bridle_tension.mean for one in every]),
        bridle_std=np.stack([one.bridle_tension.std for one in every]),
        bridle_level=every[0].bridle_level,
        node_true=net[:, ::NODES],
        node_mean=mean[:, ::NODES],
        node_std=at_nets.node_std[:, ::NODES],
        node_size=np.linalg.norm(mean - still, axis=2)[:, ::NODES],
        volume=np.stack(volume),
        buoy_change=np.array(list(_changes(buoy))),
    )


def held_water(twin: Twin, buoy: Record, time: np.ndarray, age_min: float) -> Metocean:
    """Water at the cage by samples that are no newer than an age, as the live loop finds it.

    The newest of them says how fast the water comes, and is held where more has not come.
    """
    reported = Metocean.of_record(buoy).current_velocity
    newest = np.searchsorted(buoy.time, time - np.timedelta64(round(60 * age_min), "s"), "right")
    newest = np.maximum(newest - 1, 0)
    travel = np.rint(1e6 * twin.travel_time.of(reported[newest])).astype("timedelta64[us]")
    left = np.minimum(time - travel, buoy.time[newest])
    second, at = ((one - buoy.time[0]) / np.timedelta64(1, "s") for one in (buoy.time, left))
    held = np.maximum((time - travel - buoy.time[newest]) / np.timedelta64(1, "s"), 0.0)
    known = np.stack([np.interp(at, second, c) for c in reported.T], axis=1)
    change = [twin.current_change.beyond_usual(one) for one in held.tolist()]
    return replace(Metocean.without_waves(known), current_change=np.vstack(change))


def _changes(buoy: Record) -> Iterator[float]:
    velocity = Metocean.of_record(buoy).current_velocity
    step = (buoy.time[1] - buoy.time[0]) / MINUTE
    for minutes in (12, 24, 36, 60, 120):
        rows = round(minutes / step)
        yield float(np.sqrt(np.mean((velocity[rows:] - velocity[:-rows]) ** 2)))


def _factors(twin: Twin, field: VirtualField, time: np.ndarray) -> np.ndarray:
    """Factor that the live loop has on each depth sensor's interval at some times."""
    found: list[np.ndarray] = []
    buoy = field.record.buoy
    late = buoy.time[buoy.time >= time[0]]
    answer = twin.predict(twin.travel_time.water_at(buoy, late)).without_nodes().sensor
    rule = AdaptiveConformal(rate=twin.timeouts.adapt_rate)
    for column, sensor in enumerate(twin.cage.depth_sensors):
        record: Mapping[str, np.ndarray] = field.record.sensors[sensor.name].values
        ((key, values),) = record.items()
        series = field.record.sensors[sensor.name]
        rows = np.flatnonzero(series.usable(key) & (series.time >= time[0]))
        place = np.searchsorted(late, series.time[rows], "right") - 1
        off = np.abs(values[rows] - answer.mean[place, column])
        half = 1.96 * answer.std[place, column]
        path, factor = np.empty(len(rows)), 1.0
        for row, (one, wide) in enumerate(zip(off.tolist(), half.tolist(), strict=True)):
            factor = rule.stepped(factor, held=one <= factor * wide)
            path[row] = factor
        last = np.searchsorted(series.time[rows], time, "right") - 1
        found.append(np.where(last >= 0, path[np.maximum(last, 0)], 1.0))
    return np.stack(found, axis=1)
