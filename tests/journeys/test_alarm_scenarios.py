"""What goes wrong on a settled virtual field raises the right alarm, and no other.

The small cage's field is settled, sampled every ten minutes and heard by a twin that it taught.
Each scenario goes on from the same quiet days.
"""

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from heapq import merge
from importlib import resources
from pathlib import Path

import pytest

from assessed import Assessed
from seacage.cage import Cage
from seacage.campaigns import (
    Event,
    Hidden,
    Plan,
    generated_current,
    run_campaign,
    virtual_field,
)
from seacage.records import FieldRecord, Record, Sample
from seacage.twin import Action, Happened, Training, Twin, described, train

CAGE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
START = datetime(2020, 1, 18, tzinfo=UTC)
TAUGHT, KNOWN = 12.0, 14.5
"""Days that teach the twin, and by which its usual errors are known."""

CUT = 7
"""Index of the bridle that parts: bridle-8, the middle one of its corner, with a shackle."""


class Parted(Hidden):
    """The same truth with a bridle so long that it bears nothing."""

    __slots__ = ()

    def _strung(self, cage: Cage) -> Cage:
        strung = Hidden._strung(self, cage)
        offset = list(strung.bridles.length_offset)
        offset[CUT] += 50.0
        return strung.altered(bridles={"length_offset_m": offset})


@dataclass
class Sea:
    """A twin, what its sensors said, and what they would have said with a bridle parted."""

    twin: Twin
    whole: FieldRecord
    parted: FieldRecord
    known: Assessed


@pytest.fixture(scope="module")
def sea(tmp_path_factory: pytest.TempPathFactory) -> Sea:
    folder = tmp_path_factory.mktemp("sea")
    plan = Plan.sample(0, 150, current_speed=(0.0, 1.5), hs=(0.0, 0.0), name="current")
    campaign = run_campaign(CAGE, plan, folder / "campaign.zarr", method="settle", workers=1)
    hidden = _always_alive(folder / "hidden.toml")
    buoy = generated_current(0, start=START, days=17.0)
    whole, parted = (
        virtual_field(
            CAGE,
            buoy,
            hidden=kind.read(hidden),
            seed=0,
            method="settle",
            every_s=600.0,
            kept=folder / "responses",
            workers=1,
        ).record
        for kind in (Hidden, Parted)
    )
    taught = _cut(whole, START, _at(TAUGHT))
    training = Training(high_fidelity_points=80, days=TAUGHT, restarts=0, mean_s=600.0)
    twin = train(CAGE, campaign, taught, training=training)
    known = Assessed(twin)
    _play(known, whole, TAUGHT, KNOWN)
    assert _told(known) == []
    return Sea(twin, whole, parted, known)


def _always_alive(path: Path) -> Path:
    """The hidden parameters with shackles that live on and no sensor that fails by itself."""
    own = (resources.files("seacage.campaigns") / "hidden_ace.toml").read_text("utf-8")
    lines = own.splitlines()
    for number, line in enumerate(lines):
        key = line.partition("=")[0].strip()
        if key == "windows":
            lines[number] = "windows = [[0.0, 10000.0]]"
        elif key.endswith("_per_week") and not key.startswith("drift"):
            lines[number] = f"{key} = 0.0"
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def _at(day: float) -> datetime:
    return START + timedelta(days=day)


def _cut(field: FieldRecord, start: datetime, end: datetime) -> FieldRecord:
    sensors = {name: record.between(start, end) for name, record in field.sensors.items()}
    return replace(field, buoy=field.buoy.between(start, end), sensors=sensors)


def _samples(field: FieldRecord, start: float, end: float) -> Iterator[Sample]:
    part = _cut(field, _at(start), _at(end))
    streams: list[Record] = [part.buoy, *part.sensors.values()]
    return merge(*(one.samples() for one in streams), key=lambda sample: sample.t)


def _play(watch: Assessed, field: FieldRecord, start: float, end: float) -> None:
    ticks = (_at(start) + timedelta(minutes=10 * n) for n in range(round(144 * (end - start))))
    watch.play(_samples(field, start, end), ticks)


def _gone_on(sea: Sea, field: FieldRecord, days: float) -> Assessed:
    """From the quiet days on, in another field."""
    watch = copy(sea.known)
    watch.journal = []
    _play(watch, field, KNOWN, KNOWN + days)
    return watch


def _told(watch: Assessed) -> list[str]:
    """The alarms that were raised, but for those that a spring tide raises by itself."""
    return [name for name in watch.raised if name not in ("volume.net", "domain.input")]


def _new(line: Happened) -> bool:
    return line.action is Action.RAISED


def _with(field: FieldRecord, words: str) -> FieldRecord:
    event = Event.parse(words.replace("THEN", _at(KNOWN).strftime("%Y-%m-%dT%H:%MZ")))
    sensors = {name: event.applied_to(record) for name, record in field.sensors.items()}
    return replace(field, buoy=event.applied_to(field.buoy), sensors=sensors)


@pytest.mark.slow
def test_more_quiet_days_raise_nothing(sea: Sea) -> None:
    assert _told(_gone_on(sea, sea.whole, 1.5)) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "days", "alarm"),
    [
        ("drift depth-1 THEN m_per_day=1.0", 1.5, "irregular.depth-1"),
        ("stuck shackle-3 THEN", 0.2, "irregular.shackle-3"),
        ("stuck depth-2 THEN", 0.2, "irregular.depth-2"),
        ("silent shackle-1 THEN", 0.2, "silent.shackle-1"),
        ("silent buoy-1 THEN", 0.3, "silent.buoy-1"),
        ("stuck buoy-1 THEN", 0.3, "irregular.buoy-1"),
    ],
)
def test_a_sensor_that_fails_raises_its_alarm_and_no_other(
    sea: Sea, words: str, days: float, alarm: str
) -> None:
    watch = _gone_on(sea, _with(sea.whole, words), days)
    assert _told(watch) == [alarm]
    assert watch.book.alarms[alarm].active
    assert described(watch.book.alarms[alarm], watch.policy).title


@pytest.mark.slow
def test_a_parted_bridle_raises_its_alarm_and_no_other_within_a_tide(sea: Sea) -> None:
    watch = _gone_on(sea, sea.parted, 1.0)
    assert _told(watch) == ["bridle.bridle-8"]
    (raised,) = (line for line in watch.journal if line.alarm == "bridle.bridle-8" and _new(line))
    assert raised.t - _at(KNOWN) < timedelta(hours=13)
