"""Ten-minute windows of a virtual field: what was true, and what the low fidelity answers there."""

from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.cage import Cage
from seacage.campaigns import Plan
from seacage.conventions import GRAVITY, Flag, InputError, Result, Rows, compass
from seacage.dynamics import rest_shape
from seacage.ocean import SeaState
from seacage.records import Clock, FieldRecord, Record, aligned, moment
from seacage.studies._sensor_scores import MEAN_S
from seacage.studies._stages import Stages
from seacage.twin import Metocean, StreamTimeouts

BoolPerWindow = Bool[np.ndarray, " window"]
PerReading = Float[np.ndarray, " reading"]
_EVERY_S = 2.0  # interval at which the buoy's held sample enters a window's mean [s]
_LEAST_SHARE = 0.9  # share of a window in which the buoy's sample must be sound and fresh
_LONGEST_GAP_S = 200.0
_LEAST = 40
# Of a sea up to 8 s; a measured pair of height and period may be steeper by its noise
_STEEPEST = 1.0 / 15.0

Responses = Float[np.ndarray, "window sensor"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sensors:
    """The sensors of a cage, and what their values mean as a response to the sea.

    A depth sensor's response is how far it has risen above its place in still water [m], a
    shackle's is the tension [kN]: both grow with the load.
    """

    cage: Cage  # as drawn
    # Depths in still water of the drawn cage [m]; zero for shackles
    rest: Float[np.ndarray, " sensor"]

    @classmethod
    def of(cls, cage: Cage) -> Self:
        """The sensors of a cage that comes to rest in still water."""
        still = -rest_shape(cage)[:, 2]
        depth = [still[sensor.node] for sensor in cage.depth_sensors]
        return cls(cage=cage, rest=np.array([*depth, *(0.0 for _ in cage.shackles)]))

    @property
    def names(self) -> tuple[str, ...]:
        """As in the cage's file, depth sensors first."""
        return self.cage.sensor_names

    @property
    def units(self) -> tuple[str, ...]:
        """Of the responses."""
        return ("m",) * len(self.cage.depth_sensors) + ("kN",) * len(self.cage.shackles)

    def response(self, sensor: int, value: PerReading) -> PerReading:
        """Response that a depth [m] or a tension [kN] stands for."""
        return self.rest[sensor] - value if self.units[sensor] == "m" else value

    def responses_of(
        self, node_position: Float[np.ndarray, "case node 3"], tension: Float[np.ndarray, "case _"]
    ) -> Float[np.ndarray, "case sensor"]:
        """Responses of simulated cages [m] or [kN]."""
        depth = -node_position[:, [sensor.node for sensor in self.cage.depth_sensors], 2]
        pulled = tension[:, [shackle.bridle for shackle in self.cage.shackles]] / 1000.0
        values = np.hstack([depth, pulled])
        return np.column_stack([self.response(i, column) for i, column in enumerate(values.T)])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Windows(Rows):
    """Some 10-minute windows of a field record."""

    sensors: Sensors  # whose responses these are
    end: Shaped[np.ndarray, " window"]  # of each window, UTC, ascending
    water: Metocean  # means of what the buoy reports to the twin
    # Windows that are spread evenly over the days; the others are those in which a shackle lives
    # besides
    surveyed: BoolPerWindow
    # Mean responses without any sensor's error: of the virtual field, and of the low fidelity in
    # the water reported; NaN before it is computed
    truth: Responses
    low: Responses

    def __len__(self) -> int:
        return len(self.end)

    @property
    def day(self) -> Shaped[np.ndarray, " window"]:
        """The UTC day of each window."""
        return (self.end - np.timedelta64(1, "us")).astype("datetime64[D]")

    @property
    def waves(self) -> bool:
        """Whether the low fidelity is asked with waves."""
        return bool(np.any(self.water.hs > 0.0))

    def seas(self) -> list[SeaState]:
        """The water as sea states; a sea too steep to stand gets the shortest period it may."""
        velocity, hs = self.water.current_velocity, self.water.hs
        shortest = 1.001 * np.sqrt(2.0 * np.pi * hs / GRAVITY / _STEEPEST)
        period = np.maximum(np.nan_to_num(self.water.tp), shortest)
        wave_from = compass(-self.water.wave_direction)
        return [
            SeaState(current_speed=speed, current_to=to, hs=h, tp=tp, wave_from=origin)
            for speed, to, h, tp, origin in zip(
                np.linalg.norm(velocity, axis=1).tolist(),
                compass(velocity).tolist(),
                hs.tolist(),
                period.tolist(),
                wave_from.tolist(),
                strict=True,
            )
        ]


def choose_windows(
    sensors: Sensors, field: FieldRecord, truth: FieldRecord, *, count: int, seed: int
) -> Windows:
    """Choose windows in which the truth is whole and the buoy reports.

    About ``count`` are drawn evenly over all days, one from each equal share of a day's
    windows, so that no hour of the tide is preferred; besides all in which a shackle's own
    readings are whole.

    Raises InputError: there are too few such windows to say anything.
    """
    means = [window_means(truth.sensors[name], field) for name in sensors.names]
    end = means[0][0]
    responses = np.column_stack([sensors.response(i, mean) for i, (_, mean) in enumerate(means)])
    water = buoy_water(field.buoy, end)
    whole = Windows(
        sensors=sensors,
        end=end,
        water=water,
        surveyed=np.zeros(len(end), bool),
        truth=responses,
        low=np.full(responses.shape, np.nan),
    )
    known = [*responses.T, *water.current_velocity.T]
    if whole.waves:
        known += [water.hs, *water.wave_direction.T]
    else:
        whole = replace(whole, water=Metocean.without_waves(water.current_velocity))
    usable = np.logical_and.reduce([np.isfinite(column) for column in known])
    if np.sum(usable) < _LEAST:
        raise InputError(
            f"study fidelity: the field has {np.sum(usable)} ten-minute windows with a whole truth "
            f"and a sound buoy, and needs {_LEAST}. Give a longer virtual field."
        )
    surveyed = _spread(whole.day, usable, count=count, seed=seed)
    alive = np.zeros(len(end), bool)
    for shackle in sensors.cage.shackles:
        if shackle.name in field.sensors:
            alive |= np.isfinite(window_means(field.sensors[shackle.name], field)[1])
    return replace(whole, surveyed=surveyed).rows(surveyed | (alive & usable))


def window_means(
    record: Record,  # one sensor; suspect values are left out
    field: FieldRecord,  # whose buoy says which time
    *,
    length: float = MEAN_S,  # of a window [s]
) -> tuple[Shaped[np.ndarray, " window"], Float[np.ndarray, " window"]]:
    """Ends of all windows of a field's time, and a sensor's mean over each that it has whole."""
    clock = Clock(
        every_s=length, window_s=length, max_gap_s=min(length, _LONGEST_GAP_S), suspect=False
    )
    means = aligned(record, clock, start=_shortly_after(field, 0), end=_shortly_after(field, -1))
    return means.time, next(iter(means.values.values()))


def buoy_water(buoy: Record, end: Shaped[np.ndarray, " window"]) -> Metocean:
    """Mean water over each window as a twin receives it: the buoy's last sample, held.

    NaN where the buoy was silent, stale or unsound for too long.
    """
    ago = np.arange(MEAN_S - _EVERY_S, -_EVERY_S / 2.0, -_EVERY_S)
    at = end[:, None] - (ago * 1e6).astype("timedelta64[us]")
    word = np.searchsorted(buoy.time, at, side="right") - 1
    age = (at - buoy.time[word]) / np.timedelta64(1, "s")
    fresh = (word >= 0) & (age <= StreamTimeouts().stale_after_s)
    columns = Metocean.of_record(buoy).table
    doubtful = [flags == Flag.SUSPECT for key, flags in buoy.flags.items() if "current" in key]
    columns[np.logical_or.reduce(doubtful), :2] = np.nan
    means = np.column_stack([_mean(column[word], fresh) for column in columns.T])
    length = np.linalg.norm(means[:, 3:5], axis=1, keepdims=True)
    means[:, 3:5] /= np.where(length > 0.0, length, np.nan)
    return Metocean.from_table(means)


def answer_windows(windows: Windows, stages: Stages, *, seed: int) -> Windows:
    """Windows with the low fidelity's answers; those in which it was lost are left out.

    Simulated in time where there are waves, settled where there are none.
    """
    seas = windows.seas()
    plan = Plan.listed(seas, duration=MEAN_S, seed=seed, name="windows")
    method = "simulate" if windows.waves else "settle"
    record = stages.ensure_campaign("windows", windows.sensors.cage, plan, method=method)
    low = windows.sensors.responses_of(record.node_position, record.bridle_tension)
    return replace(windows, low=low).rows(record.result != Result.DIVERGED)


def _shortly_after(field: FieldRecord, row: int) -> datetime:
    return moment(field.buoy.time[row]) + timedelta(microseconds=1)


def _mean(
    value: Float[np.ndarray, "window at"], fresh: Bool[np.ndarray, "window at"]
) -> Float[np.ndarray, " window"]:
    sound = fresh & np.isfinite(value)
    total = np.sum(np.where(sound, value, 0.0), axis=1)
    count = np.sum(sound, axis=1)
    return np.where(count >= _LEAST_SHARE * value.shape[1], total / np.maximum(count, 1), np.nan)


def _spread(
    day: Shaped[np.ndarray, " window"], usable: BoolPerWindow, *, count: int, seed: int
) -> BoolPerWindow:
    """Mark windows: as many of each day, each from its own share of that day's."""
    rng = np.random.default_rng(seed)
    days = np.unique(day[usable])
    each = max(1, round(count / len(days)))
    marked = np.zeros(len(day), bool)
    for one in days:
        there = np.flatnonzero(usable & (day == one))
        edges = np.linspace(0, len(there), min(each, len(there)) + 1)
        marked[there[(edges[:-1] + rng.random(len(edges) - 1) * np.diff(edges)).astype(int)]] = True
    return marked
