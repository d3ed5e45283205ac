"""The trained twin: its models, where they come from, and the live loop around them."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from datetime import datetime, timedelta
from pathlib import Path
from typing import Self

import numpy as np

from seacage.cage import Cage
from seacage.conventions import Flag, InputError, Origin, duration_text
from seacage.ocean import SeaState
from seacage.records import Amendment, Record, Sample, bin_keys, current_bins, instant
from seacage.twin._answer import Answer
from seacage.twin._correction import CurrentChange
from seacage.twin._discrepancy import Discrepancy
from seacage.twin._events import Answered, Event
from seacage.twin._interval_factors import (
    ADAPTATION_BLOCK,
    LOAD_POWER,
    MeanStd,
    Tracked,
    adapt_factor,
    block_begin,
    counts,
    factor_of_depths,
    factors_from_json,
    with_predictions,
)
from seacage.twin._lines._line_loads import LineLoads
from seacage.twin._metocean import Metocean, input_keys
from seacage.twin._models import Models
from seacage.twin._parted import NO_PARTED_LINES, IfParted
from seacage.twin._provenance import Provenance
from seacage.twin._saving import from_parts, read_folder, to_parts, write_folder
from seacage.twin._settings import FaultDetectorSettings, StreamTimeouts
from seacage.twin._state import Held, TwinState, is_usable
from seacage.twin._step import forget, receive
from seacage.twin._travel_time import TravelTime, microseconds


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """The input in force at a time, by the buoy's readings that are not ahead of it."""

    # One row: at the cage, and as reported; None before the first
    metocean: Metocean | None
    reported: Metocean | None
    age_s: float | None  # of the oldest part of the newest reading [s]
    trouble: str  # why it cannot be used, in one sentence; "" where it can


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Twin:
    """A cage's digital twin.

    ``train`` makes one, ``Twin.read("twin/")`` takes a saved one.
    """

    models: Models  # of every level, and the cage they are of
    provenance: Provenance  # of the models
    buoy: str = "buoy-1"  # the stream that the inputs come from
    # How long streams may be silent, late or ahead
    timeouts: StreamTimeouts = field(default_factory=StreamTimeouts)
    # Numbers of the fault detector, which reads them in ``assess``
    fault_detector: FaultDetectorSettings = field(default_factory=FaultDetectorSettings)
    # Distribution of true shapes about its shapes; None where there is none
    discrepancy: Discrepancy | None = None
    # Of the current from the buoy to the cage
    travel_time: TravelTime = field(default_factory=TravelTime)
    # Of the buoy's current, by which intervals widen while a sample is held
    current_change: CurrentChange = field(default_factory=CurrentChange)
    # Of the manifest of the folder that it was read from; empty for one that was not read
    sha256: str = field(default="", init=False)

    @classmethod
    def read(cls, folder: str | Path, *, key: bytes | None = None) -> Self:
        """Read a twin that ``write`` saved, and with a key only one that the key signs.

        Raises ModelError: a file is missing, foreign, of another version, or changed by as little
        as a byte.
        """
        settings, arrays, sha256 = read_folder(Path(folder), key=key)
        twin = cls(**from_parts(settings, arrays, source=str(folder)))
        object.__setattr__(twin, "sha256", sha256)
        return twin

    def write(self, folder: str | Path, *, key: bytes | None = None) -> None:
        """Save as a folder of JSON and safetensors, sealed by a manifest of SHA-256 sums.

        With a key, such as ``read_key`` reads, the manifest is signed by HMAC-SHA256.

        An earlier twin there is replaced.

        Raises ModelError: the folder holds something else.
        """
        parts = {one.name: getattr(self, one.name) for one in fields(self) if one.init}
        write_folder(Path(folder), *to_parts(**parts), key=key)

    @property
    def cage(self) -> Cage:
        """As it was simulated."""
        return self.models.cage

    @property
    def origin(self) -> Origin:
        """Origin of the sensors' data; "computed" where no sensor has level 2."""
        return self.provenance.origin

    @property
    def sensor_names(self) -> tuple[str, ...]:
        """Streams of the depth sensors, then of the shackles."""
        return self.cage.sensor_names

    @property
    def bridle_names(self) -> tuple[str, ...]:
        """As in the cage."""
        return self.cage.bridle_names

    def predict(self, metocean: SeaState | Sequence[SeaState] | Metocean) -> Answer:
        """Answer for each row of water; a row with an unknown input is not valid.

        ``metocean``: one sea state, several, or vectors; outside what level 1 was trained on the
        spread is widened, and ``in_domain`` is False.
        """
        water = metocean if isinstance(metocean, Metocean) else Metocean.of(metocean)
        known = water.known(self.models.inputs)
        trouble = ["" if one else "A number of the input is not known." for one in known]
        return self.models.answer(water, trouble)

    def predict_record(self, buoy: Record, *, among: Record | None = None) -> Answer:
        """Answer for each row of a buoy's record; a row that failed its checks is not valid.

        These are the answers that ``step`` gives to the record's samples, made in blocks and
        so faster; only ``step`` adapts the intervals to the sensors' readings.

        ``among``: a record that has these rows and those before them, for the time that the
        current takes to the cage; None where the rows are all there is.
        """
        keys = input_keys(self.models.inputs)
        absent = [key for key in keys if key not in buoy.values]
        if absent:
            raise InputError(
                f"{buoy.stream}: the record has no {absent[0]}. This twin was trained with "
                f"{', '.join(keys)}; give a record that has them all."
            )
        trouble = [""] * len(buoy)
        for key in keys:
            for row in np.flatnonzero(~buoy.usable(key)):
                trouble[row] = trouble[row] or _fault(buoy.stream, key, int(buoy.flags[key][row]))
        water = self.travel_time.water_at(buoy if among is None else among, buoy.time)
        return self.models.answer(water, trouble)

    def if_parted(
        self, metocean: SeaState | Sequence[SeaState] | Metocean, line: str | None = None
    ) -> IfParted:
        """What the cage would bear if a line had parted, once the transient has died.

        ``metocean``: as for ``predict``.
        ``line``: such as "bridle-8"; None for every line that was learned, one at a time.

        Raises InputError: the twin has not learned it.
        """
        if self.models.parted is None or self.models.loads is None:
            raise InputError(NO_PARTED_LINES)
        water = metocean if isinstance(metocean, Metocean) else Metocean.of(metocean)
        lines = None if line is None else [line]
        return self.models.parted.predict(self.cage, self.models.loads, water, lines)

    @property
    def unlike(self) -> str:
        """Why its cage is unlike those that widths without a sensor were learned on.

        One sentence of the sensors' level 2; "" where it is not, or too few sensors have one.
        """
        return self.models.unlike

    @property
    def emulator(self) -> LineLoads | None:
        """Loads of lines in waves with intervals about the simulator, not about the sea.

        None where the campaign had none to learn from.
        """
        return self.models.loads

    def start(self, adapted: str | None = None, *, until: datetime | None = None) -> TwinState:
        """Return the state before the first step.

        Raises InputError: ``adapted`` is something else.

        ``adapted``: from ``TwinState.adapted`` of another time; None begins with the intervals as
        trained.
        ``until``: and its ``adapted_until``; None goes on from the first step.
        """
        return TwinState(tracked=factors_from_json(adapted), adapted_until=until)

    def step(
        self, state: TwinState, sample: Sample | None, now: datetime
    ) -> tuple[TwinState, tuple[Event, ...]]:
        """Take one sample in, or let the clock tick.

        Nothing is read but the arguments: the same samples and clock give the same events.
        A tick is always answered, and so is a sample that changes the buoy's newest values.

        ``state``: from ``start`` or from the last step.
        ``sample``: None for a tick.
        ``now``: the clock, with its zone; in a replay it is the record's own.

        Of the events silence and return of streams come first, then flags of the sample, then the
        answer.
        """
        before = state
        state, notices = self.receive(state, () if sample is None else (sample,), now)
        newest, was = (one.latest(self.buoy, one.clock) for one in (state, before))
        if sample is None or newest != was:
            state, answered = self._answer(state, now)
            return state, (*notices, answered)
        return state, notices

    def receive(
        self,
        state: TwinState,
        samples: Sequence[Sample],
        now: datetime,
        *,
        amendments: Sequence[Amendment] = (),
    ) -> tuple[TwinState, tuple[Event, ...]]:
        """Take many samples in, without an answer; a tick gives it then.

        ``state``, ``now``: as for ``step``.
        ``samples``: in any order. Those without flags are checked.
        ``amendments``: flags of earlier samples that have changed since.
        """
        history_s = {self.buoy: self.travel_time.history_s}
        state, notices = receive(
            state,
            samples,
            now,
            timeouts={self.buoy: self.timeouts.stale_after_s}
            | dict.fromkeys(self.sensor_names, self.timeouts.sensor_silent_after_s),
            limits=self.timeouts,
            history_s=history_s,
            amendments=amendments,
        )
        state, disorder_s = self._adapt(state, now), self.timeouts.disorder_s
        return forget(state, now, disorder_s=disorder_s, history_s=history_s), notices

    def _adapt(self, state: TwinState, now: datetime) -> TwinState:
        """Adapt the intervals to the readings of the blocks that are due at a time.

        Readings count where there is a valid prediction to compare with. Where the clock has
        stepped back nothing is due.
        """
        until, before = block_begin(now), state.adapted_until
        state, rate = replace(state, adapted_until=until), self.timeouts.adapt_rate
        if before is None or until <= before or rate == 0.0:
            return state
        start, end = before - ADAPTATION_BLOCK, until - ADAPTATION_BLOCK
        counted = list[tuple[str, Sample, Metocean]]()
        for name in self.models.upper:
            tracked = state.tracked.get(name, Tracked())
            for sample in (taken.sample for taken in state.streams.get(name, ())):
                due = start <= sample.t < end
                if due and counts(tracked, sample, every_s=self.timeouts.adapt_every_s):
                    reading = self._reading_at(state, sample.t)
                    if reading.metocean is not None and not reading.trouble:
                        tracked = replace(tracked, counted=sample.t)
                        counted.append((name, sample, reading.metocean))
        if not counted:
            return state
        water = Metocean.joined(*(one for _, _, one in counted))
        _, first, row = np.unique(water.whole, axis=0, return_index=True, return_inverse=True)
        answer = self.models.answer(water.rows(first), [""] * len(first))
        factors = dict(state.tracked)
        for (name, sample, _), place in zip(counted, row.ravel(), strict=True):
            at = place, answer.sensor_names.index(name)
            expected = float(answer.sensor.mean[at]), float(answer.sensor.std[at])
            tracked = factors.get(name, Tracked())
            factors[name] = adapt_factor(tracked, sample, expected, rate=rate)
        return replace(state, tracked=factors)

    def _answer(self, state: TwinState, now: datetime) -> tuple[TwinState, Answered]:
        reading = self._reading_at(state, now)
        water = Metocean.from_columns({}, 1) if reading.metocean is None else reading.metocean
        held = state.held
        if reading.trouble or held is None or not held.answers(self.models, water):
            answer = self.models.answer(water, [reading.trouble])
            held = Held(models=self.models, water=water, answer=answer)
        tracked = with_predictions(state.tracked, self._predictions(held.answer))
        state = replace(state, tracked=tracked, held=None if reading.trouble else held)
        answer = self._scale(held.answer, state)
        return state, Answered(
            t=now,
            answer=answer,
            metocean=reading.metocean,
            input_age_s=reading.age_s,
            reported=reading.reported,
        )

    def _predictions(self, answer: Answer) -> dict[str, MeanStd | None]:
        """Mean and standard deviation of the sensors that have level 2."""
        mean, std = answer.sensor.mean[0].tolist(), answer.sensor.std[0].tolist()
        return {
            answer.sensor_names[column]: (mean[column], std[column]) if answer.valid[0] else None
            for column in self.models.corrections
        }

    def _scale(self, answer: Answer, state: TwinState) -> Answer:
        """Scale the intervals of sensors and lines: by their readings, or those of the depths."""
        depths = [one.name for one in self.cage.depth_sensors]
        carried = factor_of_depths(state.tracked, depths, state.silent)
        load = carried**LOAD_POWER
        sensor = np.array([carried if name in depths else load for name in answer.sensor_names])
        for column, name in enumerate(answer.sensor_names):
            tracked = state.tracked.get(name, Tracked())
            if tracked.counted is not None and name not in state.silent:
                sensor[column] = tracked.factor
        bridle = np.full(self.cage.bridle_count, load)
        bridle[[one.bridle for one in self.cage.shackles]] = sensor[len(depths) :]
        return answer.widened(bridle=bridle, sensor=sensor)

    def _reading_at(self, state: TwinState, t: datetime) -> Reading:
        """Return the buoy's newest value of each input, if it is sound and fresh.

        The newest reading governs: where it failed its checks there is no input until the next
        good one, as an older value is no measurement of the water since.
        """
        newest, keys = state.newest(self.buoy, t), input_keys(self.models.inputs)
        missing = [key for key in keys if key not in newest]
        if missing:
            trouble = f"{self.buoy} has not sent {missing[0]} yet."
            return Reading(metocean=None, reported=None, age_s=None, trouble=trouble)
        columns = {
            key: np.array([sample.values[key] if self._is_known(sample, key, t) else np.nan])
            for key, sample in newest.items()
        }
        age_s = max((t - newest[key].t).total_seconds() for key in keys)
        bad = [key for key in keys if not is_usable(newest[key], key)]
        limit_s = self.timeouts.stale_after_s
        trouble = ""
        if bad:
            trouble = _fault(self.buoy, bad[0], newest[bad[0]].flags[bad[0]])
        elif age_s > limit_s:
            trouble = (
                f"The last reading of {self.buoy} is {duration_text(age_s)} old; "
                f"{duration_text(limit_s)} is the limit."
            )
        reported = Metocean.from_columns(columns, 1)
        water = reported if trouble else self._water_at_cage(state, reported, t)
        return Reading(metocean=water, reported=reported, age_s=age_s, trouble=trouble)

    def _water_at_cage(self, state: TwinState, reported: Metocean, t: datetime) -> Metocean:
        """Water at the cage, whose current left the buoy a while ago.

        It is found anew with each current that the buoy sends, and each minute. A current that
        has come already is held, and may have changed since.
        """
        keys, travel = input_keys(["current"]), self.travel_time
        sent = max(sample.t for key, sample in state.newest(self.buoy, t).items() if key in keys)
        at = max(t.replace(second=0, microsecond=0), sent)
        left = at - timedelta(seconds=float(travel.of(reported.current_velocity)[0]))
        if self.current_change.after_s:
            change = self.current_change.beyond_usual((left - sent).total_seconds())
            reported = replace(reported, current_change=change)
        past = state.around(self.buoy, left, keys) if left < sent else ()
        if not past:
            return reported
        known = _water_of(past, keys, reported).currents
        times = [*(one[keys[0]].t for one in past), sent]
        velocity = travel.current_at(
            microseconds(np.array([*map(instant, times)])),
            np.vstack([known, reported.currents]),
            microseconds(np.array([instant(at)])),
        )
        return reported.with_currents(velocity)

    def _is_known(self, sample: Sample, key: str, t: datetime) -> bool:
        """Whether a value passed its checks and, unless every answer needs it, is fresh."""
        needed = key in input_keys(self.models.inputs)
        fresh = (t - sample.t).total_seconds() <= self.timeouts.stale_after_s
        return is_usable(sample, key) and (needed or fresh)


def replay(twin: Twin, samples: Iterable[Sample]) -> Iterator[Event]:
    """Step a twin through samples in the order in which they come.

    The clock is the latest time that a sample has had, so the same samples give the same
    events whenever they are played.
    """
    state = twin.start()
    for sample in samples:
        now = sample.t if state.clock is None else max(sample.t, state.clock)
        state, events = twin.step(state, sample, now)
        yield from events


def _water_of(
    past: Sequence[Mapping[str, Sample]], keys: Sequence[str], like: Metocean
) -> Metocean:
    """Water of the newest values of some times, with a profile where other water has one."""

    def value(one: Mapping[str, Sample], key: str) -> float:
        return one[key].values[key] if key in one and is_usable(one[key], key) else np.nan

    bins = () if like.profile is None else current_bins({key for one in past for key in one})
    every = (*keys, *(key for depth in bins for key in bin_keys(depth)))
    columns = {key: np.array([value(one, key) for one in past]) for key in every}
    own = Metocean.from_columns(columns, len(past))
    if like.profile is None or own.profile is not None:
        return own
    return replace(own, profile=np.full((len(past), 4), np.nan))


def _fault(buoy: str, key: str, flag: int) -> str:
    """Return why a value is no input."""
    word = Flag(flag).name.lower().replace("_", " ")
    return f"{buoy}: {key} is flagged {flag:d} ({word}); there is no valid input."
