"""Damage of lines is counted once, over the time that has an answer, and survives a restart."""

from collections.abc import Iterator
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from running_service import eventually, running
from seacage.conventions import YEAR, Flag, InputError
from seacage.records import Sample
from seacage.service._live._damage import DamageCounter, LineDamage
from seacage.service._live._past import Past
from seacage.service._store._store import Store, open_store
from seacage.twin import Metocean
from stores import schema
from wavy import wavy_twin

NOW = datetime(2020, 1, 18, 10, 20, tzinfo=UTC)
VALUES = {
    "current_speed_m_s": 0.4,
    "current_to_deg": 40.0,
    "hs_m": 1.5,
    "tp_s": 7.0,
    "wave_from_deg": 200.0,
}
HOUR = timedelta(hours=1)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    store = open_store(tmp_path / "live.sqlite")
    yield store
    store.close()


def reading(t: datetime, **other: float | None) -> Sample:
    values = {key: one for key, one in (VALUES | other).items() if one is not None}
    flags = dict.fromkeys(values, Flag.GOOD)
    return Sample(stream="buoy-1", t=t, values=values, flags=flags)


def put(store: Store, *samples: Sample, now: datetime = NOW) -> None:
    store.append("ace", samples, ingested=now).result()


def counter(store: Store) -> DamageCounter:
    return DamageCounter(Past(wavy_twin(), store, "ace"))


def rate(**other: float) -> float:
    """Damage of an hour to bridle 1."""
    columns = {key: np.array([one]) for key, one in (VALUES | other).items()}
    water = Metocean.from_columns(columns, 1)
    line = wavy_twin().predict(water).line
    assert line is not None
    assert line.damage_per_year is not None
    return float(line.damage_per_year[0, 0]) * 3600.0 / YEAR


def test_damage_is_the_rate_over_the_time_with_an_answer(store: Store) -> None:
    put(store, reading(NOW))
    count = counter(store)
    count.advance(NOW)
    assert count.at(NOW)["bridle-1"].damage == 0.0
    count.advance(NOW + 2 * HOUR)
    found = count.at(NOW + 2 * HOUR)["bridle-1"]
    assert found.damage == pytest.approx(2.0 * rate())
    assert (found.damage_since, found.damage_valid_h) == (NOW, 2.0)
    # a reading is stale after three hours, and what comes after is not filled
    count.advance(NOW + 5 * HOUR)
    found = count.at(NOW + 5 * HOUR)["bridle-1"]
    assert found.damage == pytest.approx(rate() * found.damage_valid_h)
    assert found.damage_valid_h == pytest.approx(3.0, abs=0.02)
    assert found.damage_valid_h + found.damage_missing_h == pytest.approx(5.0)
    assert "buoy-1" not in count.at(NOW)


@pytest.mark.parametrize("other", [{"hs_m": None}, {"tp_s": None}, {"hs_m": 4.5, "tp_s": 11.0}])
def test_a_sea_without_an_answer_wears_nothing(
    store: Store, other: dict[str, float | None]
) -> None:
    put(store, reading(NOW, **other))
    count = counter(store)
    for k in range(3):
        count.advance(NOW + k * HOUR)
    found = count.at(NOW + 2 * HOUR)["bridle-1"]
    assert (found.damage, found.damage_valid_h, found.damage_missing_h) == (0.0, 0.0, 2.0)


def test_a_restart_a_repeated_tick_and_a_late_reading_count_once(store: Store) -> None:
    put(store, reading(NOW))
    count = counter(store)
    for minutes in (0, 30, 30, 61, 61, 95):
        count.advance(NOW + timedelta(minutes=minutes))
    later = NOW + timedelta(minutes=95)
    again = counter(store)
    again.advance(later)
    assert again.at(later) == count.at(later)
    late = NOW + timedelta(minutes=10)
    put(store, reading(late, hs_m=1.0, tp_s=6.0), now=later)
    again.advance(later, [late])
    share = (10.0 * rate() + 85.0 * rate(hs_m=1.0, tp_s=6.0)) / 60.0
    assert again.at(later)["bridle-1"].damage == pytest.approx(share)
    fresh = counter(store)
    fresh.advance(later)
    assert fresh.at(later)["bridle-1"].damage == pytest.approx(share)


def test_a_clock_that_was_ahead_leaves_nothing(store: Store) -> None:
    put(store, reading(NOW))
    count = counter(store)
    count.advance(NOW)
    for hours in (30, 60):
        count.advance(NOW + hours * HOUR)
    back = NOW + HOUR
    count.rewind(back)
    count.advance(back)
    found = count.at(back)["bridle-1"]
    assert (found.damage_valid_h, found.damage_missing_h) == (1.0, 0.0)
    count.rewind(NOW - HOUR)  # before the counter began
    count.advance(NOW - HOUR)
    assert count.at(NOW - HOUR)["bridle-1"].damage_since == NOW - HOUR


def test_a_reset_is_in_the_journal_with_what_it_ended(store: Store) -> None:
    put(store, reading(NOW))
    count = counter(store)
    count.advance(NOW)
    at = NOW + timedelta(minutes=50)
    count.advance(at)
    count.reset("bridle-1", who="Night shift", why="New rope", now=at).result()
    later = at + HOUR
    count.advance(later)
    found = count.at(later)
    assert found["bridle-1"].damage == pytest.approx(rate())
    assert found["bridle-1"].damage_since == at
    assert found["bridle-2"].damage_since == NOW
    (line,) = store.journal("ace", limit=10)
    assert (line.alarm, line.action, line.who) == ("damage.bridle-1", "reset", "Night shift")
    assert line.value == pytest.approx(rate() * 50.0 / 60.0)
    # before the reset the old count stands
    assert count.at(at - timedelta(minutes=1))["bridle-1"].damage_since == NOW
    again = counter(store)
    again.advance(later)
    assert again.at(later) == found
    store.forget("ace")  # a replay begins anew
    count.load()
    assert count.at(later) == {}
    with pytest.raises(InputError, match="No damage of a line 'buoy-1'"):
        count.reset("buoy-1", who="", why="", now=later)


@pytest.mark.postgres
def test_a_server_keeps_the_same(postgres: str, store: Store) -> None:
    with schema(postgres) as url, closing(open_store(url)) as other:
        both = list[LineDamage]()
        for one in (store, other):
            put(one, reading(NOW))
            count = counter(one)
            count.advance(NOW)
            count.advance(NOW + HOUR)
            count.reset("bridle-1", who="Night shift", why="", now=NOW + HOUR).result()
            again = counter(one)
            again.advance(NOW + 3 * HOUR)
            both.append(again.at(NOW + 3 * HOUR)["bridle-1"])
        assert both[0] == both[1]
        assert both[0].damage == pytest.approx(2.0 * rate())


def test_the_state_has_the_count_and_whoever_may_acknowledge_resets_it(tmp_path: Path) -> None:
    path = "/api/v1/cages/ace/lines/bridle-1/damage/reset"
    with running(tmp_path, twin=wavy_twin()) as live:
        live.post({"stream": "buoy-1", "t": live.clock.at.isoformat(), "values": VALUES})
        live.clock.at += HOUR

        def line() -> dict[str, float]:
            return next(iter(live.state()["lines"]))

        found = eventually(line, lambda one: one["damage_valid_h"] > 0.9)
        assert found["damage"] > 0.0
        assert found["damage_missing_h"] < 0.1
        assert live.reader.post(path, json={"why": "no right"}).status_code == 403
        token = live.service.tokens.mint(["ack", "read"], keep=False, name="Ingrid")
        who = {"Authorization": f"Bearer {token}"}
        answer = live.reader.post(path, json={"why": "New rope"}, headers=who)
        assert answer.status_code == 200
        assert (answer.json()["name"], answer.json()["damage"]) == ("bridle-1", 0.0)
        nothing = path.replace("bridle-1", "buoy-1")
        assert live.reader.post(nothing, json={}, headers=who).status_code == 404
        (entry,) = [
            one
            for one in live.reader.get("/api/v1/cages/ace/journal").json()["lines"]
            if one["action"] == "reset"
        ]
        assert (entry["alarm"], entry["who"], entry["why"]) == (
            "damage.bridle-1",
            "Ingrid",
            "New rope",
        )
        assert entry["value"] == pytest.approx(found["damage"])
