import asyncio
from datetime import timedelta

import numpy as np
import pytest
from structlog.testing import capture_logs

from seacage.records import moment
from seacage.service._live._cage import LiveCage
from seacage.service._live._clock import ReplayClock
from seacage.service._live._metrics import Metrics
from seacage.service._live._replay import Replay, replay_of
from seacage.service._store._store import Store
from seacage.testing import stand_in_field, stand_in_twin


@pytest.fixture(scope="module")
def field():
    return stand_in_field(stand_in_twin().cage, days=3.0)


def test_a_replay_begins_some_hours_into_the_shackles_last_window(field):
    replay = replay_of(field.buoy, field)
    first = moment(field.buoy.time[0])
    assert replay.start == first + timedelta(days=2, hours=6)
    assert len(replay.records) == 9


def test_a_buoy_alone_is_replayed_from_its_start(field):
    assert replay_of(field.buoy).start == moment(field.buoy.time[0]) + timedelta(hours=6)


def test_half_of_a_short_record_is_left_to_be_replayed(field):
    first = moment(field.buoy.time[0])
    short = field.buoy.between(first, first + timedelta(hours=4, seconds=1))
    assert replay_of(short).start - first == pytest.approx(
        timedelta(hours=2), abs=timedelta(minutes=1)
    )


def test_a_replay_feeds_in_time_order_and_begins_anew_with_a_clean_store(field, tmp_path):
    start = moment(field.buoy.time[0]) + timedelta(hours=1)
    short = field.buoy.between(start - timedelta(hours=1), start + timedelta(hours=1))
    depth = field.sensors["depth-1"].between(start, start + timedelta(hours=1))
    replay = Replay(records=(short, depth), start=start)
    clock, store = ReplayClock(start, speed=20_000.0), Store(tmp_path / "replay.sqlite")
    cage = LiveCage(
        name="ace", twin=stand_in_twin(), store=store, clock=clock, metrics=Metrics(), tick_s=0.1
    )
    begun, fed = [], []
    begin, take = cage.begin, cage.take

    async def counted_begin(backlog, *, restart):
        begun.append(len(backlog))
        await begin(backlog, restart=restart)
        assert len(store.samples("ace", limit=999)) == len(backlog)
        if len(begun) == 2:
            raise asyncio.CancelledError

    async def counted_take(samples):
        fed.extend(samples)
        return await take(samples)

    cage.begin, cage.take = counted_begin, counted_take
    with pytest.raises(asyncio.CancelledError):
        asyncio.run(replay.feed(cage, clock))
    store.close()
    assert begun == [5, 5]
    times = [sample.t for sample in fed]
    assert times == sorted(times)
    assert len(fed) == len(short) - 5 + len(depth)


def test_no_sample_is_ahead_of_a_clock_that_begins_anew(field, tmp_path):
    start = moment(field.buoy.time[0]) + timedelta(hours=1)
    short = field.buoy.between(start - timedelta(hours=1), start + timedelta(hours=1))
    replay = Replay(records=(short,), start=start)
    clock, store = ReplayClock(start, speed=20_000.0), Store(tmp_path / "replay.sqlite")
    cage = LiveCage(
        name="ace", twin=stand_in_twin(), store=store, clock=clock, metrics=Metrics(), tick_s=0.1
    )
    begin, begun = cage.begin, []

    async def begin_late(backlog, *, restart):
        await asyncio.sleep(0.3 if begun else 0.0)  # a step comes between the end and the beginning
        begun.append(clock.now())
        await begin(backlog, restart=restart)
        if len(begun) == 4:
            raise asyncio.CancelledError

    async def live():
        stepping = asyncio.create_task(cage.run())
        try:
            await replay.feed(cage, clock)
        finally:
            stepping.cancel()

    cage.begin = begin_late
    with capture_logs() as lines, pytest.raises(asyncio.CancelledError):
        asyncio.run(live())
    store.close()
    assert min(begun[1:]) >= moment(short.time[-1])
    assert [one for one in lines if one["event"] == "flagged"] == []


def test_what_was_before_the_start_is_there_from_the_beginning(field, tmp_path):
    replay = replay_of(field.buoy, field)
    clock, store = ReplayClock(replay.start, speed=1.0), Store(tmp_path / "replay.sqlite")
    cage = LiveCage(
        name="ace", twin=stand_in_twin(), store=store, clock=clock, metrics=Metrics(), tick_s=0.1
    )
    backlog = list(replay._merge(replay.start - timedelta(hours=2), replay.start))
    assert not cage.snapshot.state.valid
    asyncio.run(cage.begin(backlog, restart=lambda: None))
    assert cage.snapshot.state.valid
    assert all(sensor.measured is not None for sensor in cage.snapshot.state.sensors)
    assert np.isfinite(cage.snapshot.answered.answer.node_position).all()
    store.close()
