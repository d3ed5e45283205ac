"""The current at several depths in a sample: at the door, in the archive, and in the past."""

from datetime import UTC, datetime

import pytest

from seacage.records import QualityState, check_sample, plain_key
from seacage.service._schemas._samples import BUOY_KEYS, SampleIn, read_samples
from seacage.service._store._aggregates import summaries
from seacage.service._store._archive import Bounds, decode_parquet, encode_parquet

STREAMS = {"buoy-1": BUOY_KEYS, "depth-1": ("depth_m",)}
VALUES = {
    "current_speed_m_s": 0.4,
    "current_to_deg": 90.0,
    "current_speed_5m_m_s": 0.35,
    "current_to_5m_deg": 80.0,
    "current_speed_20m_m_s": None,
    "current_to_20m_deg": 85.0,
}
UNTIL = datetime(2030, 1, 1, tzinfo=UTC)


def received(stream: str, values: dict[str, float | None]) -> SampleIn:
    return SampleIn(stream=stream, t="2020-01-18T00:00:00Z", values=values)


def test_a_buoy_may_carry_the_current_at_any_depth_and_a_sensor_may_not():
    samples, rejected = read_samples([received("buoy-1", VALUES)], STREAMS, until=UNTIL)
    assert not rejected
    (sample,) = samples
    assert sample.values["current_speed_5m_m_s"] == 0.35
    for stream, key in (("depth-1", "current_speed_5m_m_s"), ("buoy-1", "hs_5m_m")):
        samples, rejected = read_samples([received(stream, {key: 1.0})], STREAMS, until=UNTIL)
        assert not samples
        assert f"{stream} has no quantity {key!r}" in rejected[0].reason


def test_bins_are_checked_and_come_back_from_the_archive():
    pytest.importorskip("pyarrow")
    (sample,), _ = read_samples([received("buoy-1", VALUES)], STREAMS, until=UNTIL)
    _, checked = check_sample(QualityState(), sample)
    assert checked.flags["current_speed_5m_m_s"] == 1
    assert checked.flags["current_speed_20m_m_s"] == 9
    (again,) = decode_parquet(encode_parquet("ace", "buoy-1", [checked]), "buoy-1", Bounds())
    assert again.flags == checked.flags
    assert again.values["current_to_5m_deg"] == 80.0
    assert {plain_key(key) for key in again.values} == {"current_speed_m_s", "current_to_deg"}


def test_no_direction_at_a_depth_is_averaged():
    text = '{"current_speed_5m_m_s": [0.4, 1], "current_to_5m_deg": [350.0, 1], "hs_m": [1.0, 1]}'
    assert {quantity for quantity, *_ in summaries([(0, text)])} == {"hs_m"}
