"""Skipping what is surely good changes no verdict."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from seacage.conventions import Origin
from seacage.records import (
    DEFAULT_LIMITS,
    Limits,
    Range,
    Record,
    Season,
    check_record,
    instant,
    verdicts_on,
)
from seacage.records._quality._prefilter import Candidates, candidate_rows

NOON = datetime(2018, 1, 26, 12, tzinfo=UTC)
KEYS = {
    "current": ("current_speed_m_s", "current_to_deg"),
    "waves": ("hs_m", "tp_s"),
    "depth": ("depth_m",),
}
MIDDLE = {
    "current_speed_m_s": (1.0, 1.0),
    "current_to_deg": (180.0, 100.0),
    "hs_m": (1.5, 1.0),
    "tp_s": (8.0, 1.0),
    "depth_m": (7.0, 1.0),
}


def impatient(group: str) -> Limits:
    """Limits that find something of every kind within an hour of 2 s readings."""
    steadiness = replace(
        DEFAULT_LIMITS.steadiness[group],
        jump=0.3,
        rate=0.01,
        gap_s=30.0,
        flat_suspect_s=12.0,
        flat_fail_s=24.0,
        spike_suspect=0.25,
        spike_fail=0.6,
        attenuated_s=240.0,
        attenuated_suspect=0.3,
        attenuated_fail=0.1,
    )
    return Limits(
        ranges={**DEFAULT_LIMITS.ranges, "depth_m": Range(fail=(4.0, 12.0), suspect=(6.0, 8.0))},
        steadiness={**DEFAULT_LIMITS.steadiness, group: steadiness},
        climatology={
            "depth_m": (Season(months=(1,), range=Range(fail=(3, 12), suspect=(6, 7.8))),)
        },
    )


def rough(group: str, seed: int, *, size: int = 900) -> Record:
    """Readings that wander, jump, spike, stand still, fall asleep, go missing and pause."""
    rng = np.random.default_rng(seed)
    seconds = np.cumsum(rng.choice([2.0, 2.0, 2.0, 4.0], size) + 40.0 * (rng.random(size) < 0.005))
    awake = np.where(np.arange(size) % 600 < 300, 1.0, 0.02)
    values: dict[str, np.ndarray] = {}
    still = rng.random(size) < np.where(np.arange(size) % 150 < 20, 0.97, 0.1)
    source = np.maximum.accumulate(np.where(still, 0, np.arange(size)))
    for key in KEYS[group]:
        middle, scale = MIDDLE[key]
        values[key] = middle + 0.1 * scale * awake * rng.normal(size=size)
        values[key] += scale * awake * rng.normal(size=size) * (rng.random(size) < 0.02)
        values[key] = np.where(rng.random(size) < 0.01, np.nan, values[key])[source]
    time = instant(NOON) + (seconds * 1e6).astype("timedelta64[us]")
    return Record(stream="any-1", time=time, values=values, origin=Origin.MEASURED)


def verdict_rows(record: Record, limits: Limits) -> list[tuple[object, ...]]:
    return [
        (one.key, one.test, one.flag, one.rows.tolist(), one.example)
        for one in verdicts_on(record, limits)
    ]


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("group", KEYS)
def test_verdicts_are_those_of_judging_every_row(
    group: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    record, limits = rough(group, seed), impatient(group)
    skipping = verdict_rows(record, limits)

    def everything(_: str, time: np.ndarray, *__: object) -> Candidates:
        return Candidates([slice(0, len(time))], np.ones(len(time), dtype=bool))

    monkeypatch.setattr("seacage.records._quality._check.candidate_rows", everything)
    assert skipping == verdict_rows(record, limits)
    tests = {test for _, test, *_ in skipping}
    assert {"missing value", "gap", "flat line", "attenuated signal"} <= tests
    assert tests & {"spike", "rate of change"}


def test_of_a_healthy_record_hardly_a_row_is_checked() -> None:
    rng = np.random.default_rng(1)
    depth = 7.0 + 0.5 * np.sin(np.arange(50_000) / 3.0) + rng.normal(scale=0.03, size=50_000)
    depth[20_000] += 20.0
    time = np.arange(50_000) * 2_000_000
    stretches = candidate_rows("depth", time, {"depth_m": depth}, DEFAULT_LIMITS).stretches
    assert sum(rows.stop - rows.start for rows in stretches) < 10
    assert any(rows.start <= 20_000 < rows.stop for rows in stretches)


def test_an_empty_record_is_checked_too() -> None:
    empty = Record(
        stream="depth-1",
        time=np.empty(0, dtype="datetime64[us]"),
        values={"depth_m": np.empty(0)},
        origin=Origin.MEASURED,
    )
    assert len(check_record(empty)) == 0
