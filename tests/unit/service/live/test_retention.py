import asyncio
from datetime import timedelta

import pytest

from seacage.conventions import InputError
from seacage.service._assembly import assemble
from seacage.service._live._clock import AbstractClock, floor_time
from seacage.service._live._retention import retire_old_days
from seacage.service._settings import Settings, read_settings
from seacage.service._store._store import look_into, open_store
from seacage.testing import stand_in_twin
from stores import NOON, put, sample

A_DAY = 60 * 24


class NoonClock(AbstractClock):
    def now(self):
        return NOON


@pytest.fixture
def store(tmp_path):
    one = open_store(tmp_path / "samples.sqlite")
    yield one
    one.close()


def looked(store, *, times=1, keep_days=2):
    """Let retention look so often, then stop it."""

    async def look():
        looks = retire_old_days(
            store, clocks={"ace": NoonClock()}, keep_days=keep_days, every_s=0.05
        )
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(looks, 0.3 * times)

    asyncio.run(look())


def test_days_older_than_those_to_keep_leave_the_store(store):
    put(store, *(sample(-A_DAY * k) for k in range(5)))
    put(store, sample(-A_DAY * 9), cage="ice")
    looked(store)
    assert store.samples("ace", limit=9) == [sample(-A_DAY * k) for k in (2, 1, 0)]
    assert len(store.samples("ice", limit=9)) == 1


def test_a_disk_that_takes_nothing_is_tried_again(store):
    put(store, sample(-A_DAY * 9))
    writer = store._database._writer
    writer.execute("PRAGMA query_only = ON")
    looked(store)
    assert len(store.samples("ace", limit=9)) == 1
    writer.execute("PRAGMA query_only = OFF")
    looked(store)
    assert store.samples("ace", limit=9) == []


def test_the_day_that_is_being_measured_stays_however_short_samples_are_kept(store):
    put(store, sample(-A_DAY), sample(-60), sample(0))
    looked(store, keep_days=0.1)
    assert store.samples("ace", limit=9) == [sample(-60), sample(0)]


def test_to_keep_nothing_is_refused():
    with pytest.raises(InputError, match="keep_days = 0 does not do"):
        read_settings(store={"keep_days": 0})


def test_midnight_is_that_of_utc():
    assert floor_time(NOON, timedelta(days=1)) == NOON - timedelta(hours=12)


def test_a_service_that_is_set_to_archives_and_lets_go(tmp_path):
    kept = {"keep_days": 30.0, "archive": tmp_path / "archive"}
    service = assemble(Settings(data=tmp_path, store=kept), {"ace": stand_in_twin()})
    put(service.store, sample(), sample(60 * 24))

    def left():
        with look_into(tmp_path / "samples.sqlite") as session:
            return session.rows("SELECT count(*) FROM sample")[0][0]

    async def serve():
        service.begin()
        for _ in range(200):
            await asyncio.sleep(0.05)
            if not left():
                break
        read = service.store.samples("ace", limit=9)
        await service.end()
        return read

    assert asyncio.run(serve()) == [sample(), sample(60 * 24)]
    assert left() == 0
    assert len(list(tmp_path.glob("archive/ace/depth-1/*.parquet"))) == 2
