from datetime import UTC, datetime
from pathlib import Path

import pytest

from seacage.service._live._alarm_desk import AlarmDesk
from seacage.service._live._past import Past
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin
from seacage.twin import AlarmPolicy

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


@pytest.fixture
def store(tmp_path: Path):
    one = Store(tmp_path / "samples.sqlite")
    yield one
    one.close()


def desk_of(store: Store) -> AlarmDesk:
    twin = stand_in_twin()
    return AlarmDesk(Past(twin, store, "ace"), policy=AlarmPolicy.default(twin.cage))


def looked(desk: AlarmDesk) -> set[str]:
    """The alarms that are active once a tick was judged."""
    twin = stand_in_twin()
    state, (answered,) = twin.step(twin.start(), None, NOON)
    desk.look(state, answered)
    return {name for name, alarm in desk.alarms.items() if alarm.active}


def test_alarms_that_cannot_be_read_back_are_an_alarm_themselves(store: Store):
    assert "history.store" not in looked(desk_of(store))
    store.keep_alarms("ace", book="{}garbage", journal=()).result()
    desk = desk_of(store)
    assert "history.store" in looked(desk)
    assert "cannot be read" in desk.alarms["history.store"].detail


def test_what_happens_is_announced_to_who_listens(store: Store):
    store.keep_alarms("ace", book="none", journal=()).result()
    desk, report = desk_of(store), []
    desk.subscribe(report.append)
    looked(desk)
    assert [(one.cage, one.alarm.name, one.happened.action) for one in report] == [
        ("ace", "history.store", "raised")
    ]
    assert report[0].text.title
    assert [one.alarm.name for one in desk.standing()] == ["history.store"]


def test_a_replays_new_beginning_forgets_every_alarm(store: Store):
    desk = desk_of(store)
    looked(desk)
    desk.begin_anew()
    assert not desk.alarms


def test_an_alarm_out_of_service_waits_for_nobody(store: Store):
    store.keep_alarms("ace", book="none", journal=()).result()
    desk = desk_of(store)
    looked(desk)
    assert [one.id for one in desk.waiting()] == ["history.store"]
    desk.handle("history.store", "out-of-service", who="me", now=NOON, why="trial", seconds=None)
    assert not desk.waiting()
