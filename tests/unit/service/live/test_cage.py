import asyncio
from contextlib import closing
from datetime import timedelta

from running_service import NOON, HandClock
from seacage.records import Sample
from seacage.service._live import _cage
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin


def depth(minutes, metres):
    t = NOON + timedelta(minutes=minutes)
    return Sample(stream="depth-2", t=t, values={"depth_m": metres})


def test_a_cage_that_is_ordered_to_stop_as_something_arrives_stops(tmp_path):
    async def work(cage):
        for _ in range(5):
            running = asyncio.create_task(cage.run())
            await asyncio.sleep(0.3)
            while cage._stepping.locked() or cage._arrived.is_set():
                await asyncio.sleep(0.0)
            await asyncio.sleep(0.15)  # now it waits
            cage._arrived.set()
            await asyncio.sleep(0.0)  # the arrival is on its way
            running.cancel()
            done, _ = await asyncio.wait([running], timeout=2.0)
            assert done

    with closing(Store(tmp_path / "samples.sqlite")) as store:
        parts = {"store": store, "clock": HandClock(), "metrics": Metrics()}
        asyncio.run(work(LiveCage(name="ace", twin=stand_in_twin(), tick_s=60.0, **parts)))


def test_who_sends_more_than_the_twin_can_step_through_is_made_to_wait(tmp_path, monkeypatch):
    monkeypatch.setattr(_cage, "MOST_WAITING", 3)

    async def work(cage):
        await cage.take([depth(k, 14.0 + k / 10) for k in range(3)])
        late = asyncio.create_task(cage.take([depth(3, 14.3)]))
        done, _ = await asyncio.wait([late], timeout=0.5)
        assert not done
        running = asyncio.create_task(cage.run())
        assert await asyncio.wait_for(late, timeout=10.0) == (True,)
        running.cancel()

    with closing(Store(tmp_path / "samples.sqlite")) as store:
        parts = {"store": store, "clock": HandClock(), "metrics": Metrics()}
        asyncio.run(work(LiveCage(name="ace", twin=stand_in_twin(), **parts)))
