"""The trained twin: its models, where they come from, and the live loop around them."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path
from typing import Self

import numpy as np

from seacage.cage import Cage
from seacage.conventions import InputError, Origin
from seacage.ocean import SeaState
from seacage.records import Amendment, Record, Sample
from seacage.twin._adaptation import Adapter
from seacage.twin._answer import Answer
from seacage.twin._discrepancy import Discrepancy
from seacage.twin._events import Answered, Event
from seacage.twin._interval_factors import Expected, expecting, factors_from_json
from seacage.twin._metocean import INPUT_KEYS, Metocean
from seacage.twin._models import Models
from seacage.twin._provenance import Provenance
from seacage.twin._reading import failed, held_reading
from seacage.twin._saving import read_folder, restored, saved, write_folder
from seacage.twin._state import Held, TwinState, Watch
from seacage.twin._step import forgotten, received


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Twin:
    """A cage's digital twin.

    ``train`` makes one, ``Twin.read("twin/")`` takes a saved one.

    Parameters
    ----------
    models
        Of every level, and the cage they are of.
    provenance
        What they were learned from.
    buoy
        The stream that the inputs come from.
    watch
        How long streams may be quiet, late or ahead.
    discrepancy
        How far real nets were from its shapes; None where nobody has looked.
    """

    models: Models
    provenance: Provenance
    buoy: str = "buoy-1"
    watch: Watch = field(default_factory=Watch)
    discrepancy: Discrepancy | None = None

    @classmethod
    def read(cls, folder: str | Path, *, key: bytes | None = None) -> Self:
        """Read a twin that ``write`` saved, and with a key only one that the key signs.

        Raises
        ------
        ModelError
            A file is missing, foreign, of another version, or changed by as little as a byte.
        """
        return cls(**restored(*read_folder(Path(folder), key=key), source=str(folder)))

    def write(self, folder: str | Path, *, key: bytes | None = None) -> None:
        """Save as a folder of JSON and safetensors, sealed by a manifest of SHA-256 sums.

        With a key, such as ``read_key`` reads, the manifest is signed by HMAC-SHA256.

        An earlier twin there is replaced.

        Raises
        ------
        ModelError
            The folder holds something else.
        """
        parts = self.models, self.provenance, self.buoy, self.watch, self.discrepancy
        write_folder(Path(folder), *saved(*parts), key=key)

    @property
    def cage(self) -> Cage:
        """As it was simulated."""
        return self.models.cage

    @property
    def origin(self) -> Origin:
        """Where the sensors' lessons came from; "computed" where no sensor taught."""
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

        Parameters
        ----------
        metocean
            One sea state, several, or vectors; outside what level 1 was trained on the spread
            is widened, and ``in_domain`` is False.
        """
        water = metocean if isinstance(metocean, Metocean) else Metocean.of(metocean)
        return self.models.answer(
            water,
            [
                "" if one else "A number of the input is not known."
                for one in water.known(self.models.inputs)
            ],
        )

    def predict_record(self, buoy: Record) -> Answer:
        """Answer for each row of a buoy's record; a row that failed its checks is not valid.

        These are the answers that ``step`` gives to the record's samples, made in blocks and
        so faster; what the sensors' own readings make of the intervals, ``step`` alone knows.
        """
        keys = self._keys()
        absent = [key for key in keys if key not in buoy.values]
        if absent:
            raise InputError(
                f"{buoy.stream}: the record has no {absent[0]}. This twin was trained with "
                f"{', '.join(keys)}; give a record that has them all."
            )
        trouble = [""] * len(buoy)
        for key in keys:
            for row in np.flatnonzero(~buoy.usable(key)):
                trouble[row] = trouble[row] or failed(buoy.stream, key, int(buoy.flags[key][row]))
        return self.models.answer(Metocean.of_record(buoy), trouble)

    def start(self, adapted: str | None = None, *, until: datetime | None = None) -> TwinState:
        """Return the state before the first step.

        Parameters
        ----------
        adapted
            From ``TwinState.adapted`` of another time; None begins with the intervals as
            trained.
        until
            And its ``adapted_until``; None goes on from the first step.

        Raises
        ------
        InputError
            ``adapted`` is something else.
        """
        tracked = factors_from_json(adapted) if adapted is not None else {}
        return TwinState(tracked=tracked, adapted_until=until)

    def step(
        self, state: TwinState, sample: Sample | None, now: datetime
    ) -> tuple[TwinState, tuple[Event, ...]]:
        """Take one sample in, or let the clock tick.

        Nothing is read but the arguments: the same samples and clock give the same events.
        A tick is always answered, and so is a sample that changes the buoy's last word.

        Parameters
        ----------
        state
            From ``start`` or from the last step.
        sample
            None for a tick.
        now
            The clock, with its zone; in a replay it is the record's own.

        Returns
        -------
        state, events
            Silence and return of streams first, then what was wrong with the sample, then
            the answer.
        """
        before = state
        state, notices = self.receive(state, () if sample is None else (sample,), now)
        if sample is None or _newest(state, self.buoy) != _newest(before, self.buoy):
            state, answered = self._answered(state, now)
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

        Parameters
        ----------
        state, now
            As for ``step``.
        samples
            In any order. Those that carry flags are believed; the others are checked.
        amendments
            Flags of earlier samples that have changed since.
        """
        state, notices = received(
            state,
            samples,
            now,
            timeouts=self._timeouts(),
            watch=self.watch,
            amendments=amendments,
        )
        adapter = Adapter(models=self.models, buoy=self.buoy, watch=self.watch)
        state = adapter.adapted(state, now)
        return forgotten(state, now, disorder_s=self.watch.disorder_s), notices

    def _answered(self, state: TwinState, now: datetime) -> tuple[TwinState, Answered]:
        stale_after_s = self.watch.stale_after_s
        stream = state.streams.get(self.buoy, ())
        reading = held_reading(
            stream, now, buoy=self.buoy, keys=self._keys(), stale_after_s=stale_after_s
        )
        unknown = Metocean.from_columns({}, 1)
        water = unknown if reading.metocean is None else reading.metocean
        held = None if reading.trouble else state.held
        if held is not None and held.answers(self.models, water):
            answer = held.answer
        else:
            answer = self.models.answer(water, [reading.trouble])
            held = Held(models=self.models, water=water, answer=answer)
        tracked = expecting(state.tracked, self._expected(answer))
        state = replace(state, tracked=tracked, held=None if reading.trouble else held)
        answer = self._adapted(answer, state)
        return state, Answered(
            t=now, answer=answer, metocean=reading.metocean, input_age_s=reading.age_s
        )

    def _expected(self, answer: Answer) -> dict[str, Expected | None]:
        """What is expected of the sensors that have level 2."""
        mean, std = answer.sensor.mean[0].tolist(), answer.sensor.std[0].tolist()
        return {
            name: (mean[column], std[column]) if answer.valid[0] else None
            for column, name in enumerate(answer.sensor_names)
            if name in self.models.upper
        }

    def _adapted(self, answer: Answer, state: TwinState) -> Answer:
        """Widen or narrow the intervals of sensors that speak, and of the ropes they are on."""
        factor = {
            name: 1.0 if name in state.silent else tracked.factor
            for name, tracked in state.tracked.items()
        }
        bridle = np.ones(self.cage.bridle_count)
        for shackle in self.cage.shackles:
            bridle[shackle.bridle] = factor.get(shackle.name, 1.0)
        sensor = np.array([factor.get(name, 1.0) for name in answer.sensor_names])
        return answer.widened(bridle=bridle, sensor=sensor)

    def _keys(self) -> list[str]:
        return [key for name in self.models.inputs for key in INPUT_KEYS[name]]

    def _timeouts(self) -> dict[str, float]:
        sensors = dict.fromkeys(self.sensor_names, self.watch.sensor_silent_after_s)
        return {self.buoy: self.watch.stale_after_s, **sensors}


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


def _newest(state: TwinState, stream: str) -> Sample | None:
    """The newest sample of a stream that governed at the state's clock."""
    return state.latest(stream, state.clock)
