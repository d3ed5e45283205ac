"""The truth of a virtual field that is simulated in time, put together from its stretches."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int, Shaped

from seacage.cage import Cage
from seacage.campaigns._buoy_records import usable_waves
from seacage.campaigns._virtual_field._events import Event, check_events
from seacage.campaigns._virtual_field._spells import Spells
from seacage.campaigns._virtual_field._stretches import StretchStore, TrueCage, simulate_stretches
from seacage.campaigns._virtual_field._timetable import Stretch, Timetable, cut
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.campaigns._virtual_field._weather import Weather, true_weather
from seacage.conventions import InputError, Progress, SeacageError
from seacage.records import GROUPS, Record, TrueMeans, check_record, instant

_DAY, _HOUR = 86400.0, 3600.0
_LOOKS = 10  # at the water during each mean
_LATEST = np.timedelta64(6, "h")  # waves are held no longer


# No slots: the weather is made once and kept.
@dataclass(frozen=True, kw_only=True)
class FieldRequest:
    """A virtual field to simulate, and all that its truth depends on."""

    # As for ``virtual_field``; the buoy's record takes up the waves
    cage: Cage
    buoy: Record
    time: Shaped[np.ndarray, " reading"]  # of the readings, in even steps
    hidden: TruthParameters
    seed: int
    waves: Record | None = None
    events: Sequence[Event] = ()
    timetable: Timetable

    def __post_init__(self) -> None:
        check_events(self.events, self.cage, self.buoy, self.hidden)
        if self.waves is None and self.buoy.values.keys() >= set(GROUPS["waves"]):
            object.__setattr__(self, "waves", self.buoy)
        if self.waves is not None:
            object.__setattr__(self, "buoy", _with_waves(self.buoy, self.waves))

    @property
    def every(self) -> float:
        """Between readings [s]."""
        return float((self.time[1] - self.time[0]) / np.timedelta64(1, "s"))

    @cached_property
    def weather(self) -> Weather:
        """True weather at the cage."""
        hidden, depth = self.hidden, self.cage.site.water_depth
        return true_weather(
            self.buoy, self.waves, hidden=hidden, seed=self.seed, every_s=self.every, depth=depth
        )

    @cached_property
    def stretches(self) -> tuple[Stretch, ...]:
        """Stretches to simulate."""
        each, _ = self.timetable.readings(self.every)
        damages = [(event, event.damage(self.cage)) for event in self.events]
        return cut(
            len(self.time),
            each,
            one_in=self.timetable.one_in,
            always=Spells.at_shares(self.time, self.hidden.shackle.windows).cover(self.time),
            breaks=[
                (int(np.searchsorted(self.time, instant(event.at))), damage)
                for event, damage in damages
                if damage is not None
            ],
        )

    @property
    def identity(self) -> dict[str, object]:
        """Identity of the field's stretches, whichever of them are simulated."""
        cutting = {key: value for key, value in asdict(self.timetable).items() if key != "one_in"}
        return {
            "cage": self.cage.to_toml(),
            "hidden_parameters_sha256": self.hidden.sha256,
            "seed": self.seed,
            "buoy_record_sha256": self.buoy.sha256,
            "waves_sha256": None if self.waves is None else self.waves.sha256,
            "damage": [str(one) for one in self.events if one.damage(self.cage) is not None],
            "timetable": {"every": self.every, **cutting},
        }


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Truth:
    """Truth along a whole record; NaN where nothing was simulated."""

    depth_position: Float[np.ndarray, "reading depth_sensor 3"]  # of the depth sensors [m]
    bridle_tension: Float[np.ndarray, "reading bridle"]  # [N]
    # What the waves add to the pressure at each depth sensor [m]
    wave_head: Float[np.ndarray, "reading depth_sensor"]
    means: TrueMeans  # what no sensor sees
    # Stretches that left the finite numbers: gaps like those not simulated
    lost: tuple[Stretch, ...]

    @property
    def available(self) -> Bool[np.ndarray, " reading"]:
        """Mask of the readings that were simulated."""
        return np.isfinite(self.bridle_tension[:, 0])

    def readings(self, cage: Cage) -> Float[np.ndarray, "reading sensor"]:
        """Error-free readings of each sensor of the cage [m or kN]."""
        bridles = [shackle.bridle for shackle in cage.shackles]
        tension = self.bridle_tension[:, bridles].astype(np.float64) / 1e3
        return np.hstack([-self.depth_position[..., 2].astype(np.float64), tension])


def simulate_share(
    request: FieldRequest,
    folder: Path,
    *,
    share: tuple[int, int] = (0, 1),
    workers: int | None = None,
    progress: Progress | None = None,
) -> StretchStore:
    """Simulate every n-th stretch of a field into a folder, unless it is there.

    ``request``: the field. ``folder``: keeps the stretches, each as soon as it is done. ``share``:
    which share, from 0, and of how many. ``workers``: processes; None for one per available core.
    ``progress``: called as ("virtual field, simulated hours", done, total), in whole hours.
    """
    kept = StretchStore.opened(folder, request.identity)
    which, shares = share
    if not 0 <= which < shares:
        raise InputError(f"Share {which} of {shares} does not exist. Shares count from 0.")
    mine = request.stretches[which::shares]
    each = request.timetable.stretch / _HOUR

    def report(done: float) -> None:
        if progress is not None:
            total = math.ceil(len(mine) * each)
            progress("virtual field, simulated hours", min(round(done * each), total), total)

    simulate_stretches(
        mine,
        kept,
        request.weather,
        cage=TrueCage.of(request.cage, request.hidden),
        timetable=request.timetable,
        every=request.every,
        workers=workers,
        report=report,
    )
    return kept


def gather_truth(request: FieldRequest, kept: StretchStore) -> Truth:
    """The truth along the whole record, from its stretches.

    Raises SeacageError: not one stretch stayed finite.
    """
    readings, cage = len(request.time), request.cage
    position = np.full((readings, len(cage.depth_sensors), 3), np.nan, np.float32)
    head = np.full(position.shape[:2], np.nan, np.float32)
    tension = np.full((readings, cage.bridle_count), np.nan, np.float32)
    _, of_mean = request.timetable.readings(request.every)
    lost: list[Stretch] = []
    firsts: list[int] = []
    shapes: list[Float[np.ndarray, "mean node 3"]] = []
    for stretch in request.stretches:
        passed = kept.read(stretch)
        if passed.lost:
            lost.append(stretch)
            continue
        position[stretch.rows] = passed.watched_position[: stretch.readings]
        head[stretch.rows] = passed.wave_head[: stretch.readings]
        tension[stretch.rows] = passed.bridle_tension[: stretch.readings]
        whole = stretch.readings // of_mean
        firsts += [stretch.first + of_mean * number for number in range(whole)]
        shapes.append(passed.shape[:whole])
    if not shapes:
        raise SeacageError(
            f"The virtual field's cage broke all {len(lost)} simulations: its hidden parameters "
            "are out of reach of the time step. Weaken them or give a shorter one."
        )
    return Truth(
        depth_position=position,
        bridle_tension=tension,
        wave_head=head,
        means=_means(request, np.array(firsts), of_mean, np.concatenate(shapes), tension),
        lost=tuple(lost),
    )


def _means(
    request: FieldRequest,
    first: Int[np.ndarray, " mean"],
    of_mean: int,
    shape: Float[np.ndarray, "mean node 3"],
    tension: Float[np.ndarray, "reading bridle"],
) -> TrueMeans:
    each = tension[first[:, None] + np.arange(of_mean)].astype(np.float64)
    length = request.timetable.mean
    begin = first * request.every
    looks = begin[:, None] + length * (np.arange(_LOOKS) + 0.5) / _LOOKS
    weather = request.weather
    current = np.array([[weather.current(second) for second in row] for row in looks.tolist()])
    middle = begin + length / 2.0
    variances = [weather.waves(second).variance for second in middle.tolist()]
    return TrueMeans(
        time=request.time[first],
        length=length,
        bridle_names=request.cage.bridle_names,
        level_depth=np.array(weather.level_depth),
        bridle_tension_mean=each.mean(axis=1),
        bridle_tension_std=each.std(axis=1),
        bridle_tension_max=each.max(axis=1),
        node_position=shape,
        current_velocity=current.mean(axis=1),
        hs=4.0 * np.sqrt(np.array(variances)),
        growth=request.hidden.fouling.grown(middle / _DAY),
    )


def _with_waves(buoy: Record, waves: Record) -> Record:
    """The buoy's record with the last waves at each of its times, all checked anew."""
    time, values = usable_waves(waves)
    if time[0] > buoy.time[0] or time[-1] + _LATEST < buoy.time[-1]:
        first, last = (moment.astype("datetime64[m]") for moment in time[[0, -1]])
        raise InputError(
            f"{waves.stream}: its waves last from {first}Z to {last}Z and not as long as the "
            f"current of {buoy.stream}. Give waves of the same days."
        )
    held = values[np.searchsorted(time, buoy.time, side="right") - 1]
    columns = dict(zip(GROUPS["waves"], held.T, strict=True))
    notes = tuple(dict.fromkeys(buoy.notes + waves.notes))
    return check_record(replace(buoy, values={**buoy.values, **columns}, flags={}, notes=notes))
