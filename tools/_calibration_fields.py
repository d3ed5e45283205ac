"""What a trained twin answers on fields of the family's cages, beside the truth, as arrays."""

import argparse
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
from _family_fields import (
    START,
    Water,
    field_of,
    scored_times,
    values_at,
    with_every_shackle,
    without_extra,
)

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, VirtualField, true_nets
from seacage.records import Record
from seacage.surrogates import AdaptiveConformal
from seacage.twin import Answer, Metocean, Training, Twin, train

AGES_MIN = (0.0, 10.0, 30.0, 60.0)  # least, of the buoy's newest sample
NODE_TIMES, NODES = 12, 8  # nodes are scored every twelfth half hour, and every eighth of them
AGED_TIMES = 4  # and answers to an older input every fourth, where no nodes are asked for
DAY = np.timedelta64(86400, "s")
# Growth that begins where the depth sensors' training ends, is half done ten days later, and is
# never cleaned
HEAVY = {"age_days": 0.0, "cleaned_days": (), "half_grown_days": 35.0, "growth_days": 4.0}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Outputs:
    """Of several outputs of one field: the truth, and answers by age of the input."""

    true: np.ndarray  # (time, output)
    mean: np.ndarray  # (age, time, output)
    std: np.ndarray  # as if the input were new
    late: np.ndarray  # as it is
    trained: np.ndarray  # day on which the training ended that the output rests on
    fastest: np.ndarray  # current in it [m/s]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answers:
    """Of one field."""

    day: np.ndarray  # of the field, (time)
    velocity: np.ndarray  # of the current at the cage by the twin [m/s], (time, 2)
    growth: np.ndarray  # true [-], (time)
    factor: np.ndarray  # online, of the depth sensors, (time, depth)
    size: np.ndarray  # displacement of the nodes by the twin [m], (time, node)
    groups: dict[str, Outputs]

    def at_nets(self) -> "Answers":
        """Return the same at the times of the nets."""
        some = slice(None, None, NODE_TIMES)
        whole = ("day", "velocity", "growth", "factor")
        return replace(self, **{name: getattr(self, name)[some] for name in whole})

    @classmethod
    def read(cls, path: Path) -> "Answers":
        """Read what ``write`` wrote."""
        with np.load(path) as stored:
            own = {name: stored[name] for name in stored.files if ":" not in name}
            groups: dict[str, dict[str, np.ndarray]] = {}
            for name in stored.files:
                if ":" in name:
                    group, field = name.split(":")
                    groups.setdefault(group, {})[field] = stored[name]
        return cls(groups={name: Outputs(**one) for name, one in groups.items()}, **own)

    def write(self, path: Path) -> None:
        """Keep the arrays."""
        own = {one.name: getattr(self, one.name) for one in fields(self) if one.name != "groups"}
        of_groups = {
            f"{name}:{one.name}": getattr(group, one.name)
            for name, group in self.groups.items()
            for one in fields(group)
        }
        np.savez_compressed(path, **own, **of_groups)


def answers_of(base: Twin, number: int, given: argparse.Namespace, *, heavy: bool) -> Answers:
    """Train on one field, and answer; twin and answers are kept in the output folder."""
    water: Water = "tame" if number % 2 else "coastal"
    kept = given.out / f"truth-{number}{'-heavy' * heavy}.npz"
    if not kept.is_file():
        hidden = TruthParameters.of_family(number, water=water, unseal=given.unseal)
        if heavy:
            hidden = replace(hidden, fouling=replace(hidden.fouling, **HEAVY))
        full, folder = with_every_shackle(base.cage), f"truth-{number}"
        field = field_of(full, number, water, given, name=folder, hidden=hidden)
        record, stored = without_extra(field.record), kept.with_suffix(".twin")
        if not stored.is_dir():
            train(base.cage, None, record, base=base, training=Training(restarts=1)).write(stored)
        nets = scored_times(field.truth.buoy)[::NODE_TIMES]
        where = {"kept": given.out / folder, "workers": given.workers}
        net = true_nets(full, field.truth.buoy, nets, hidden=hidden, seed=number, **where)
        _answers(Twin.read(stored), replace(field, record=record), full, hidden, net).write(kept)
    return Answers.read(kept)


def _answers(
    twin: Twin, field: VirtualField, full: Cage, hidden: TruthParameters, net: np.ndarray
) -> Answers:
    time, truth = scored_times(field.record.buoy), field.truth
    waters = [held_water(twin, field.record.buoy, time, age) for age in AGES_MIN]
    new = [twin.predict(_new(waters[0])).without_nodes()]
    late, rows = [new[0]], np.arange(0, len(time), AGED_TIMES)
    for one in waters[1:]:
        late.append(twin.predict(one.rows(rows)).without_nodes())
        new.append(twin.predict(_new(one.rows(rows))).without_nodes())
    some = np.arange(0, len(time), NODE_TIMES)
    late_nets = [twin.predict(one.rows(some)) for one in waters]
    new_nets = [twin.predict(_new(one.rows(some))) for one in waters]
    day = (time - np.datetime64(START.replace(tzinfo=None))) / DAY
    ends, fastest = _training(twin)
    depths = len(twin.cage.depth_sensors)
    sensors = np.stack([values_at(truth.sensors[k], time) for k in twin.sensor_names], axis=1)
    bridles = np.full((len(time), full.bridle_count), np.nan)
    for shackle in full.shackles:
        bridles[:, shackle.bridle] = values_at(truth.sensors[shackle.name], time)
    alone = late[0].bridle_level == 1
    still = twin.models.net.still if twin.models.net else 0.0

    def put_together(
        true: np.ndarray, answers: tuple[list[Answer], list[Answer]], name: str, columns: slice
    ) -> Outputs:
        first, second = ([_moments(one, name) for one in each] for each in answers)
        mean = _spread([one[0] for one in first])
        std, wide = (_spread([one[1] for one in each]) for each in (second, first))
        own = columns if name == "sensor" else slice(depths) if name == "node" else slice(depths, 8)
        end, most = (np.resize(one[own], true.shape[1]) for one in (ends, fastest))
        return Outputs(true=true, mean=mean, std=std, late=wide, trained=end, fastest=most)

    both, nets = (late, new), (late_nets, new_nets)
    sensor = put_together(sensors, both, "sensor", slice(None))
    volume = full.volume(net) / twin.models.still_volume
    mean = late_nets[0].node_position
    return Answers(
        day=day,
        velocity=waters[0].current_velocity,
        growth=hidden.fouling.grown(day),
        factor=_factors(twin, field, time),
        size=np.linalg.norm(mean - still, axis=2)[:, ::NODES],
        groups={
            "depths": _columns(sensor, np.arange(depths)),
            "shackles": _columns(sensor, np.arange(depths, len(twin.sensor_names))),
            "bridles of level 1": _columns(
                put_together(bridles, both, "bridle", slice(None)), np.flatnonzero(alone)
            ),
            "nodes": put_together(net[:, ::NODES].reshape(len(net), -1), nets, "node", slice(None)),
            "volume": put_together(volume[:, None], nets, "volume", slice(None)),
        },
    )


def _spread(each: list[np.ndarray]) -> np.ndarray:
    """Stack arrays by age; NaN where an older input was not asked for."""
    found = np.full((len(each), *each[0].shape), np.nan)
    for place, one in zip(found, each, strict=True):
        place[:: len(place) // len(one)] = one
    return found


def _new(water: Metocean) -> Metocean:
    return replace(water, current_change=None)


def _moments(answer: Answer, name: str) -> tuple[np.ndarray, np.ndarray]:
    if name == "sensor":
        return answer.sensor.mean, answer.sensor.std
    if name == "bridle":
        return answer.bridle_tension.mean, answer.bridle_tension.std
    if name == "volume":
        return answer.volume_fraction[:, None], answer.volume_std[:, None]
    mean, std = (one[:, ::NODES] for one in (answer.node_position, answer.node_std))
    return mean.reshape(len(mean), -1), std.reshape(len(std), -1)


def _columns(one: Outputs, some: np.ndarray) -> Outputs:
    return Outputs(**{f.name: getattr(one, f.name)[..., some] for f in fields(one)})


def _training(twin: Twin) -> tuple[np.ndarray, np.ndarray]:
    """Day on which each sensor's training ended, and its fastest current; NaN without level 2."""
    ends, fastest = np.full((2, len(twin.sensor_names)), np.nan)
    for column, model in twin.models.corrections.items():
        end = twin.provenance.training_windows[twin.sensor_names[column]].end
        ends[column] = (end - START).total_seconds() / 86400.0
        fastest[column] = model.domain.upper[0]
    return ends, fastest


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


def _factors(twin: Twin, field: VirtualField, time: np.ndarray) -> np.ndarray:
    """Factor that the live loop has on each depth sensor's interval at some times."""
    found: list[np.ndarray] = []
    buoy = field.record.buoy
    late = buoy.time[buoy.time >= time[0]]
    answer = twin.predict(twin.travel_time.water_at(buoy, late)).without_nodes().sensor
    rule = AdaptiveConformal(rate=twin.timeouts.adapt_rate)
    for column, sensor in enumerate(twin.cage.depth_sensors):
        series = field.record.sensors[sensor.name]
        ((key, values),) = series.values.items()
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
