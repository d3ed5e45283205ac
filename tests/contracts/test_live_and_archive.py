"""The flags that a live service leaves behind are those of the archive."""

import asyncio
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from running_service import HandClock
from seacage.conventions import Flag, Origin
from seacage.records import Record, check_record, instant, moment, read_record
from seacage.service._live._cage import LiveCage
from seacage.service._live._metrics import Metrics
from seacage.service._store._store import Store
from seacage.testing import stand_in_twin

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


def troubled_depth() -> Record:
    """Some hours of a depth sensor with spikes, jumps, gaps and values that are none."""
    random = np.random.default_rng(4)
    size = 300
    depth = 7.0 + np.cumsum(random.normal(0.0, 0.02, size))
    spikes = random.random(size) < 0.05
    depth[spikes] += random.normal(0.0, 8.0, np.sum(spikes))
    depth[random.random(size) < 0.03] = np.nan
    depth[random.random(size) < 0.02] = -99.0
    depth[200:210] += 12.0
    seconds = np.cumsum(random.choice([2, 60, 120, 300, 4000], size, p=[0.3, 0.3, 0.2, 0.19, 0.01]))
    time = instant(NOON) + seconds * np.timedelta64(1, "s")
    return Record(
        stream="depth-1", time=time, values={"depth_m": depth}, origin=Origin.VIRTUAL_FIELD
    )


def left_behind(record: Record, folder: Path, *, batch: int) -> dict[str, list[int]]:
    """Flags in the store after a record came in batches, with a restart in its middle."""
    clock, half = HandClock(), len(record) // 2 // batch * batch
    samples = list(record.samples())
    for part in (samples[:half], samples[half:]):
        clock.at = part[0].t - timedelta(seconds=1)
        store = Store(folder / "samples.sqlite")
        cage = LiveCage(
            name="ace", twin=stand_in_twin(), store=store, clock=clock, metrics=Metrics()
        )

        async def fed(cage: LiveCage = cage, part: list = part) -> None:
            for start in range(0, len(part), batch):
                await cage.take(part[start : start + batch])

        asyncio.run(fed())
        stored = store.samples("ace", limit=len(record) + 1)
        store.close()
    assert len(stored) == len(record)
    return {key: [one.flags[key] for one in stored] for key in record.values}


@pytest.mark.parametrize("batch", [3, 30])
def test_a_live_stream_leaves_the_flags_of_the_archive(tmp_path: Path, batch: int) -> None:
    record = troubled_depth()
    checked = check_record(record)
    assert {Flag.GOOD, Flag.SUSPECT, Flag.FAIL, Flag.MISSING} == set(
        checked.flags["depth_m"].tolist()
    )
    assert any("stands out" in note for note in checked.notes)
    assert left_behind(record, tmp_path, batch=batch)["depth_m"] == (
        checked.flags["depth_m"].tolist()
    )


def test_a_real_buoy_with_spikes_leaves_the_flags_of_the_archive(
    tmp_path: Path, shared: Path
) -> None:
    whole = read_record(shared / "data/buoy_current_s08010_2018.csv")
    raw = whole.between(moment(whole.time[0]), moment(whole.time[1000]))
    speed = raw.values["current_speed_m_s"].copy()
    speed[100::97] += 1.2
    record = Record(
        stream=raw.stream,
        time=raw.time,
        values={**raw.values, "current_speed_m_s": speed},
        origin=raw.origin,
    )
    checked = check_record(record)
    assert any("stands out" in note for note in checked.notes)
    live = left_behind(record, tmp_path, batch=100)
    for key, flags in checked.flags.items():
        assert live[key] == flags.tolist()
