"""The true weather at the cage, of which the buoy knows a part."""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Self

import numpy as np
from jaxtyping import Float

from seacage import ocean
from seacage.campaigns._buoy_records import (
    seconds_of,
    shortest_period,
    span_of,
    usable_waves,
    wandering,
)
from seacage.campaigns._virtual_field._truth_parameters import (
    FoulingTruth,
    ProfileTruth,
    TruthParameters,
)
from seacage.conventions import InputError, compass, towards
from seacage.dynamics import AbstractWeather
from seacage.records import Record

PerPanel = Float[np.ndarray, " panel"]
PerRow = Float[np.ndarray, " row"]
PerT = Float[np.ndarray, " t"]

_DAY = 86400.0
_MINUTE = 60.0  # step in which sea and profile change, and for which waves are good [s]
_RIPPLE = 1.0  # shortest peak period: a flat sea has a frequency too [s]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Even:
    """Values in even steps from second 0 on, straight between them."""

    step: float  # between rows [s]
    values: Float[np.ndarray, "row value"]  # two rows at least
    first: int = 0  # row of the whole that comes first here
    count: int | None = None  # rows of the whole; None where all are here

    def at(self, second: float | PerT, *, held: bool = True) -> Float[np.ndarray, "*t value"]:
        """Values at a time or some.

        Beyond the whole the end values are held, or go on as straight as the last step if not
        ``held``.

        Raises InputError: a time of the whole that was cut off.
        """
        place = np.asarray(second / self.step - self.first)
        self._check(float(place.min()), float(place.max()))
        row = np.clip(np.floor(place), 0, len(self.values) - 2).astype(np.intp)
        share = (place - row)[..., None]
        if held:
            share = np.clip(share, 0.0, 1.0)
        return (1.0 - share) * self.values[row] + share * self.values[row + 1]

    def between(self, start: float, end: float) -> Self:
        """The rows around the time from one second to another."""
        last = len(self.values)
        low = min(max(math.floor(start / self.step) - self.first, 0), last - 2)
        high = max(min(math.ceil(end / self.step) - self.first + 1, last), low + 2)
        values = self.values[low:high].copy()
        return replace(self, values=values, first=self.first + low, count=self.count or last)

    def _check(self, least: float, most: float) -> None:
        last = len(self.values) - 1
        early = self.first > 0 and least < 0.0
        late = self.count is not None and self.first + last + 1 < self.count and most > last
        if early or late:
            wrong = (least if early else most) + self.first
            raise InputError(
                f"Weather: second {wrong * self.step:g} is not among those kept, "
                f"{self.first * self.step:g} to {(self.first + last) * self.step:g}. "
                "Keep a longer time with `between`."
            )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrueWaves:
    """Waves that stay the same ones while their sea and the current change."""

    draw: ocean.WaveDraw  # what chance decided about them
    sea: Even  # hs [m], Tp [s] and, (east, north), where the waves go
    phase: Even  # of each at the origin, never folded [rad]
    depth: float  # of the water [m]

    def at(self, second: float) -> ocean.Waves:
        """Waves whose time 0 is then, and that meet those of a minute later."""
        hs, tp, east, north = self.sea.at(second).tolist()
        came = float(compass(np.array([-east, -north])))
        sea = ocean.SeaState(current_speed=0.0, current_to=0.0, hs=hs, tp=tp, wave_from=came)
        now = self.phase.at(second, held=False)
        later = self.phase.at(second + _MINUTE, held=False)
        return replace(
            self.draw.waves(sea, depth=self.depth),
            angular_frequency=(now - later) / _MINUTE,
            phase=now % (2.0 * math.pi),
        )

    def between(self, start: float, end: float) -> Self:
        """What matters from one second to another."""
        return replace(
            self, sea=self.sea.between(start, end), phase=self.phase.between(start, end + _MINUTE)
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Weather(AbstractWeather):
    """True weather at the cage, in seconds since the buoy's first time.

    Before that time and after the buoy's last, current and sea are as they are there.
    """

    surface: Even  # current near the surface, (east, north) [m/s]
    swing: Even  # how far the profile's factor and turn are off, over their standard deviations [-]
    shear: Even | None  # (east, north), what the deepest level has beside it [m/s]
    sea: TrueWaves  # the waves
    # How the current changes with depth, and how growth adds solidity
    profile: ProfileTruth
    fouling: FoulingTruth

    @property
    def level_depth(self) -> tuple[float, ...]:
        """Of the current's levels [m]."""
        return self.profile.depth_m

    def current(self, second: float) -> Float[np.ndarray, "level 2"]:
        """East and north at each level [m/s]."""
        own = self.profile
        deep = np.array(own.depth_m) / own.depth_m[-1]
        stronger, turned = self.swing.at(second)
        factor = own.factor + own.factor_sd * stronger * deep
        turn = own.turned_deg + own.turned_sd_deg * turned * deep
        profile = ocean.CurrentProfile(
            depth=own.depth_m,
            factor=tuple(np.maximum(factor, 0.0).tolist()),
            turned=tuple(turn.tolist()),
        )
        velocity = profile.velocity(self.surface.at(second))
        return velocity if self.shear is None else velocity + np.outer(deep, self.shear.at(second))

    def waves(self, second: float) -> ocean.Waves:
        """For the minute from then on, whose time 0 is then."""
        return self.sea.at(second)

    def netting(self, second: float, depth: PerPanel) -> tuple[PerPanel, PerPanel]:
        """Solidity added by growth at some depths [m], and the drag factor of what grew [-]."""
        (growth,) = self.fouling.grown(np.array([max(second, 0.0) / _DAY]))
        return self.fouling.solidity_and_drag(float(growth), depth)

    def pressure_head(
        self, second: PerT, position: Float[np.ndarray, "t *sensor 3"]
    ) -> Float[np.ndarray, "t *sensor"]:
        """Wave pressure at places that move, as metres of water [m].

        ``second``: ascending [s]. ``position``: of one sensor or some at each time: east, north, up
        from still water [m].
        """
        time = second.reshape(len(second), *(1,) * (position.ndim - 2))
        minutes, firsts = np.unique(np.floor(second / _MINUTE), return_index=True)
        places, times = (np.split(each, firsts[1:]) for each in (position, time))
        heads = [
            ocean.pressure_head(self.waves(start), there, then - start)
            for start, there, then in zip(_MINUTE * minutes, places, times, strict=True)
        ]
        return np.concatenate(heads)

    def between(self, start: float, end: float) -> Self:
        """What matters from one second to another, small enough to send about."""
        return replace(
            self,
            surface=self.surface.between(start, end),
            swing=self.swing.between(start, end),
            shear=None if self.shear is None else self.shear.between(start, end),
            sea=self.sea.between(start, end),
        )


def true_weather(
    buoy: Record,
    waves: Record | None,
    *,
    hidden: TruthParameters,
    seed: int,
    every_s: float = 2.0,
    depth: float = 191.0,
) -> Weather:
    """The weather behind a buoy's record.

    Nothing in it depends on which stretch of time is looked at later. The periods of the record
    of waves count as seen from the moving water. Left out: what a current does to the waves'
    heights, and the shelter of the neighbour cages from waves.

    ``buoy``: its current, with an error of its own. ``waves``: as they are at the cage; None for a
    calm sea. Unusable rows are bridged. ``hidden``: how the truth differs. ``seed``: of the buoy's
    error, eddies, profile and waves, each with a stream of its own. ``every_s``: between the
    current's samples [s]. ``depth``: of the water [m].

    Raises InputError: fewer than two usable currents or waves.
    """
    water, deep, surface = water_chance(seed)
    span = span_of(buoy.time)
    seconds = np.arange(math.ceil(span / every_s) + 1) * every_s
    current = Even(step=every_s, values=current_at_cage(buoy, seconds, hidden=hidden, rng=water))
    minutes = np.arange(math.ceil(span / _MINUTE) + 1) * _MINUTE
    memory = hidden.profile.memory_s
    swing = wandering(deep, len(minutes), sd=1.0, step_s=_MINUTE, memory_s=memory)
    sheared = shear(hidden.profile, len(minutes), _MINUTE, seed=seed)
    components = 0 if waves is None else hidden.waves.components
    draw = ocean.WaveDraw.sample(surface, components=components, spreading=hidden.waves.spreading)
    sea = _sea(waves, buoy.time[0], minutes)
    phase = _phase(draw, sea, current.at(minutes[:-1] + _MINUTE / 2.0), depth)
    by_minute = partial(Even, step=_MINUTE)
    sea, phase = by_minute(values=sea), by_minute(values=phase)
    return Weather(
        surface=current,
        swing=by_minute(values=swing),
        shear=by_minute(values=sheared) if hidden.profile.shear_sd_m_s else None,
        sea=TrueWaves(draw=draw, sea=sea, phase=phase, depth=depth),
        profile=hidden.profile,
        fouling=hidden.fouling,
    )


def water_chance(seed: int) -> list[np.random.Generator]:
    """Chance of the buoy's error and eddies, of the profile, and of the waves."""
    # the word keeps these streams apart from those of others who have the same seed
    return np.random.default_rng([seed, *b"weather"]).spawn(3)


def shear(
    profile: ProfileTruth, steps: int, step_s: float, *, seed: int
) -> Float[np.ndarray, "step 2"]:
    """What the deepest level has beside the profile of the current, (east, north) [m/s]."""
    rng = np.random.default_rng([seed, *b"shear"])
    sd, memory = profile.shear_sd_m_s, profile.shear_memory_s
    return wandering(rng, steps, sd=sd, step_s=step_s, memory_s=memory)


def _sea(waves: Record | None, start: np.datetime64, seconds: PerRow) -> Float[np.ndarray, "row 4"]:
    """Hs [m], Tp [s] and where the waves go, (east, north), at some seconds after a time."""
    if waves is None:
        return np.tile([0.0, _RIPPLE, 0.0, 1.0], (len(seconds), 1))
    time, rows = usable_waves(waves)
    hs, tp, came = rows.T
    known = np.column_stack([hs, tp, -towards(np.ones(len(came)), came)])
    sea = _between(seconds, seconds_of(time, start), known)
    sea[:, 1] = np.maximum(np.maximum(sea[:, 1], shortest_period(sea[:, 0])), _RIPPLE)
    return sea


def _phase(
    draw: ocean.WaveDraw,
    sea: Float[np.ndarray, "row 4"],
    current: Float[np.ndarray, "step 2"],
    depth: float,
) -> Float[np.ndarray, "row wave"]:
    """Phases at the origin, of waves that a current carries past [rad]."""
    middle = (sea[1:] + sea[:-1]) / 2.0
    frequency = 2.0 * math.pi / middle[:, 1:2] * draw.frequency
    # by the compass, since a sea that turns right round passes through no direction at all
    ahead = towards(np.ones(len(middle)), compass(middle[:, 2:]))
    right = ocean.turn_vectors(ahead, np.array(math.pi / 2.0))
    along, across = (np.sum(way * current, axis=1) for way in (ahead, right))
    speed = np.outer(along, np.cos(draw.turned)) + np.outer(across, np.sin(draw.turned))
    frequency += ocean.wavenumber(frequency, depth=depth) * speed
    turned = np.cumsum(frequency * _MINUTE, axis=0)
    return draw.phase - np.vstack([np.zeros_like(draw.phase), turned])


def current_at_cage(
    buoy: Record, seconds: PerT, *, hidden: TruthParameters, rng: np.random.Generator
) -> Float[np.ndarray, "t 2"]:
    """The true current at the cage (east, north) [m/s].

    What the buoy reported, less the buoy's own error, arrives later, slowed and turned by
    its direction, with eddies that the buoy does not see.

    ``buoy``: its unusable rows are bridged by its neighbours. ``seconds``: since the buoy's first
    time, in even steps [s].
    """
    there, at_buoy = _true_at_buoy(buoy, hidden=hidden, rng=rng)
    way = hidden.current
    lag = _lag(_between(seconds, there, at_buoy), hidden)
    arrived = _between(seconds - lag, there, at_buoy)
    step, sd, memory = float(seconds[1] - seconds[0]), way.residual_sd_m_s, way.residual_memory_s
    eddies = wandering(rng, len(seconds), sd=sd, step_s=step, memory_s=memory)
    # Slowed and turned on its way, smoothly by direction
    to = compass(arrived)
    factor = _swing(to, way.factor_least, way.factor_most, way.factor_most_to_deg)
    turn = _swing(to, way.turn_least_deg, way.turn_most_deg, way.turn_most_to_deg)
    return towards(np.linalg.norm(arrived, axis=1) * factor, to + turn) + eddies


def current_at_buoy(
    buoy: Record, seconds: PerT, *, hidden: TruthParameters, rng: np.random.Generator
) -> tuple[Float[np.ndarray, "t 2"], PerT]:
    """The true current at the buoy [m/s], and when that water is at the cage [s].

    ``buoy``, ``seconds``, ``rng``: as of ``current_at_cage``, from the same state of chance.
    """
    now = _between(seconds, *_true_at_buoy(buoy, hidden=hidden, rng=rng))
    return now, seconds + _lag(now, hidden)


def _true_at_buoy(
    buoy: Record, *, hidden: TruthParameters, rng: np.random.Generator
) -> tuple[PerRow, Float[np.ndarray, "row 2"]]:
    """Times since the first row [s] and currents of the usable rows, without the buoy's error."""
    usable = buoy.usable("current_speed_m_s") & buoy.usable("current_to_deg")
    if np.sum(usable) < 2:
        raise InputError(
            f"{buoy.stream}: {np.sum(usable)} usable currents in {len(buoy)} rows. "
            "A virtual field needs two at least."
        )
    reported = towards(buoy.values["current_speed_m_s"], buoy.values["current_to_deg"])[usable]
    speed, noise = np.linalg.norm(reported, axis=1), hidden.buoy
    return seconds_of(buoy.time[usable], buoy.time[0]), towards(
        np.maximum(speed - rng.normal(scale=noise.speed_sd_m_s, size=len(speed)), 0.0),
        compass(reported) - rng.normal(scale=noise.direction_sd_deg, size=len(speed)),
    )


def _lag(current: Float[np.ndarray, "t 2"], hidden: TruthParameters) -> PerT:
    way, speed = hidden.current, np.linalg.norm(current, axis=1)
    return np.minimum(way.distance_m / np.maximum(speed, 1e-6), way.lag_most_s)


def _between(
    at: PerT, seconds: PerRow, values: Float[np.ndarray, "row value"]
) -> Float[np.ndarray, "t value"]:
    return np.column_stack([np.interp(at, seconds, column) for column in values.T])


def _swing(to: PerT, least: float, most: float, most_to: float) -> PerT:
    """From least to most and back, once round the compass."""
    share = (1.0 + np.cos(np.deg2rad(to - most_to))) / 2.0
    return least + (most - least) * share
