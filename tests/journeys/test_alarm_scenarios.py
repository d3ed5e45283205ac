"""What goes wrong on a settled virtual field raises the right alarm, and no other.

The truth is cage ``ace`` with its hidden parameters, whole and damaged; its kept answers are held
against the solver below. The twin learns from a coarser mesh and from twenty days of sensors, then
hears them every ten minutes as a service does. Each scenario goes on from the same quiet days.
"""

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from heapq import merge
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from damaged import ACE, DAMAGES, damaged_field, kept_answers, settled_answers
from seacage.campaigns import Event, Plan, TruthParameters, run_campaign
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, FieldRecord, Record, Sample
from seacage.twin import Action, AlarmEvent, Training, alarm_text, train
from twin_harness import TwinHarness

pytestmark = pytest.mark.timeout(600)

COARSE = ACE.altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
START = datetime(2020, 1, 18, tzinfo=UTC)
TRAINED, KNOWN, QUIET = 20.0, 22.5, 27.0
"""Days that teach the twin, by which its usual errors are known, and after a quiet week."""

TICK = timedelta(minutes=15)


@dataclass
class Sea:
    """A whole cage, its twin, and what that heard until things go wrong."""

    hidden: TruthParameters
    campaign: CampaignRecord
    whole: FieldRecord
    known: TwinHarness

    def damaged(self, damage: str) -> FieldRecord:
        """What the same sensors would have said of a damaged cage."""
        return _field(damage, self.hidden)


@pytest.fixture(scope="module")
def sea(tmp_path_factory: pytest.TempPathFactory) -> Sea:
    folder = tmp_path_factory.mktemp("sea")
    plan = Plan.sample(0, 150, current_speed=(0.0, 1.5), hs=(0.0, 0.0), name="current")
    campaign = run_campaign(COARSE, plan, folder / "campaign.zarr", method="settle", workers=1)
    hidden = TruthParameters.read(_always_alive(folder / "hidden.toml"))
    whole = _field("whole", hidden)
    return Sea(hidden, campaign, whole, _known(campaign, whole))


def _known(campaign: CampaignRecord, whole: FieldRecord) -> TwinHarness:
    """A twin taught by a field, after some quiet days of it."""
    trained = _cut(whole, START, _at(TRAINED))
    training = Training(high_fidelity_points=60, days=TRAINED, restarts=0, mean_s=600.0)
    known = TwinHarness(train(COARSE, campaign, trained, training=training))
    _play(known, whole, TRAINED, KNOWN)
    return known


def _field(damage: str, hidden: TruthParameters) -> FieldRecord:
    return damaged_field(
        damage, hidden=hidden, seed=0, start=START, days=QUIET + 1.0, every_s=600.0
    )


def _always_alive(path: Path) -> Path:
    """The hidden parameters with shackles that live on, and nothing that happens by itself."""
    own = (resources.files("seacage.campaigns._virtual_field") / "hidden_ace.toml").read_text(
        "utf-8"
    )
    lines = own.splitlines()
    for number, line in enumerate(lines):
        key = line.partition("=")[0].strip()
        if key == "windows":
            lines[number] = "windows = [[0.0, 10000.0]]"
        elif key == "cleaned_days":  # a cleaning looks like a hole
            lines[number] = "cleaned_days = [1000.0]"
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


def _play(watch: TwinHarness, field: FieldRecord, start: float, end: float) -> None:
    count = round((_at(end) - _at(start)) / TICK)
    watch.play(_samples(field, start, end), (_at(start) + n * TICK for n in range(count)))


def _gone_on(known: TwinHarness, field: FieldRecord, days: float) -> TwinHarness:
    """From the quiet days on, in another field."""
    watch = copy(known)
    watch.journal = []
    _play(watch, field, KNOWN, KNOWN + days)
    return watch


def _raised_by_fault(watch: TwinHarness) -> list[str]:
    """The alarms that were raised, but for those that a spring tide raises by itself."""
    return [name for name in watch.raised if name not in ("volume.net", "domain.input")]


def _delay(watch: TwinHarness, alarm: str) -> timedelta:
    (raised,) = (line for line in watch.journal if line.alarm == alarm and _new(line))
    return raised.t - _at(KNOWN)


def _new(line: AlarmEvent) -> bool:
    return line.action is Action.RAISED


def _with(field: FieldRecord, words: str) -> FieldRecord:
    event = Event.parse(words.replace("THEN", _at(KNOWN).strftime("%Y-%m-%dT%H:%MZ")))
    sensors = {name: event.apply_to(record) for name, record in field.sensors.items()}
    return replace(field, buoy=event.apply_to(field.buoy), sensors=sensors)


@pytest.mark.parametrize("damage", DAMAGES)
def test_the_kept_answers_are_those_of_the_damaged_cage(damage: str) -> None:
    kept, hidden = kept_answers(damage), TruthParameters.read()
    speed, towards = [3, 6, 9], [2, 7, 15]
    seas = [
        SeaState(current_speed=kept.speed[i], current_to=float(np.rad2deg(kept.direction[j])))
        for i, j in zip(speed, towards, strict=True)
    ]
    now = settled_answers(damage, hidden, kept.growth[1], seas)
    # The solver stops at a small residual, and the kept numbers have 24 bits.
    np.testing.assert_allclose(kept.value[1, speed, towards], now, rtol=1e-3, atol=0.01)


@pytest.mark.slow
def test_a_quiet_week_raises_nothing(sea: Sea) -> None:
    watch = _gone_on(sea.known, sea.whole, QUIET - KNOWN)
    assert _raised_by_fault(sea.known) + _raised_by_fault(watch) == []
    assert QUIET - TRAINED >= 7.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "days", "alarm"),
    [
        ("drift depth-1 THEN m_per_day=1.0", 1.5, "irregular.depth-1"),
        ("stuck shackle-3 THEN", 0.2, "irregular.shackle-3"),
        ("stuck buoy-1 THEN", 0.3, "irregular.buoy-1"),
        ("silent shackle-1 THEN", 0.2, "silent.shackle-1"),
        ("silent buoy-1 THEN", 0.3, "silent.buoy-1"),
    ],
)
def test_a_sensor_that_fails_raises_its_alarm_and_no_other(
    sea: Sea, words: str, days: float, alarm: str
) -> None:
    watch = _gone_on(sea.known, _with(sea.whole, words), days)
    assert _raised_by_fault(watch) == [alarm]
    assert watch.book.alarms[alarm].active
    assert alarm_text(watch.book.alarms[alarm], watch.policy).title


@pytest.mark.slow
def test_a_parted_bridle_raises_its_alarm_and_no_other_within_a_tide(sea: Sea) -> None:
    watch = _gone_on(sea.known, sea.damaged("parted"), 1.0)
    assert _raised_by_fault(watch) == ["bridle.bridle-8"]
    assert _delay(watch, "bridle.bridle-8") < timedelta(hours=13)


@pytest.mark.slow
def test_a_large_hole_raises_the_net_s_alarm_and_no_other_within_days(sea: Sea) -> None:
    watch = _gone_on(sea.known, sea.damaged("torn"), 2.0)
    assert _raised_by_fault(watch) == ["net.net"]
    assert _delay(watch, "net.net") < timedelta(days=2)
