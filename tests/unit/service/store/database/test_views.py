"""Views for other programs, in either database: what they show, and how they are kept."""

import math
import sqlite3
from contextlib import closing, contextmanager
from dataclasses import replace
from datetime import timedelta

import psycopg
import pytest

from seacage.records import KEYS, Limits
from seacage.service._store._aggregates import QUANTITIES
from seacage.service._store._damage import Stretch
from seacage.service._store._database._sqlite import _make_views
from stores import NOON, opened, put, sample, schema

VIEWS = ("readings", "readings_10min", "alarms", "alarm_journal", "line_damage")


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request, tmp_path):
    if request.param == "sqlite":
        yield tmp_path / "samples.sqlite"
    else:
        with schema(request.getfixturevalue("postgres")) as url:
            yield url


@contextmanager
def asking(place):
    """Lend a way to run statements beside the store."""
    if isinstance(place, str):
        with psycopg.connect(place, autocommit=True) as connection:
            yield connection.execute
    else:
        with closing(sqlite3.connect(place, isolation_level=None)) as connection:
            yield connection.execute


def rows_of(ask, view):
    cursor = ask(f"SELECT * FROM {view}")
    names = [name for name, *_ in cursor.description]
    return [dict(zip(names, row, strict=True)) for row in cursor.fetchall()]


def test_every_quantity_is_a_column(place):
    with opened(place), asking(place) as ask:
        columns = {
            view: [name for name, *_ in ask(f"SELECT * FROM {view}").description]
            for view in ("readings", "readings_10min")
        }
    assert set(columns["readings"][5:]) == set(KEYS)
    assert set(columns["readings_10min"][4:]) == set(QUANTITIES)


def test_readings_that_failed_or_are_no_numbers_are_null(place):
    strange = [math.nan, math.inf, -math.inf, 1e6]
    with opened(place) as store, asking(place) as ask:
        put(store, sample(-1), *[sample(k, one) for k, one in enumerate(strange)], limits=Limits())
        found = sorted(rows_of(ask, "readings"), key=lambda one: one["t_us"])
    assert [one["depth_m"] for one in found] == [14.0, None, None, None, None]
    assert all("depth_m" in one["remarks"] for one in found[1:])
    assert found[0]["t_us"] == (NOON - timedelta(minutes=1)).timestamp() * 1e6
    assert str(found[0]["t_utc"]).startswith("2020-02-01 11:59:00")


def test_values_beside_each_other_each_have_their_column(place):
    sea = {"hs_m": 1.5, "tp_s": 7.0, "wave_from_deg": 200.0, "current_speed_m_s": 0.5}
    with opened(place) as store, asking(place) as ask:
        put(store, replace(sample(stream="buoy-1"), values=sea), limits=Limits())
        (found,) = rows_of(ask, "readings")
    assert {key: found[key] for key in KEYS} == dict.fromkeys(KEYS) | sea


def test_damage_has_a_row_for_each_line(place):
    stretch = Stretch(t=NOON, damage={"frame-1": 1e-6, "anchor-2": 0.0}, valid=50, missing=10)
    with opened(place) as store, asking(place) as ask:
        store.keep_damage("ace", (NOON, NOON + timedelta(hours=1)), [stretch]).result(20)
        found = rows_of(ask, "line_damage")
    assert {one["line"]: one["damage"] for one in found} == stretch.damage
    assert {(one["valid_min"], one["missing_min"]) for one in found} == {(50, 10)}


def test_views_of_another_seacage_are_made_anew_and_others_are_left(place):
    opened(place).thing.close()
    mark = "COMMENT ON VIEW readings IS 'Made by seacage 1'"
    with asking(place) as ask:
        for view in VIEWS[:4]:
            ask(f"DROP VIEW {view}")
        ask("CREATE VIEW readings AS SELECT 1 AS old")
        ask("CREATE TABLE alarms (mine TEXT)")
        if isinstance(place, str):
            ask(mark)
            ask("CREATE VIEW alarm_journal AS SELECT 2 AS mine")
    with opened(place) as store, asking(place) as ask:
        put(store, sample())
        assert rows_of(ask, "readings")[0]["depth_m"] == 14.0
        assert rows_of(ask, "readings_10min") == rows_of(ask, "alarms") == []
        if isinstance(place, str):
            assert rows_of(ask, "alarm_journal") == [{"mine": 2}]


def test_a_view_that_others_rest_on_does_not_keep_the_store_shut(postgres):
    with schema(postgres) as url, asking(url) as ask:
        opened(url).thing.close()
        ask("COMMENT ON VIEW readings IS 'Made by seacage 1'")
        ask("CREATE VIEW mine AS SELECT depth_m FROM readings")
        with opened(url) as store:
            put(store, sample())
            assert rows_of(ask, "mine") == [{"depth_m": 14.0}]


def test_a_role_may_read_the_views_alone(postgres):
    with schema(postgres) as url, asking(url) as ask, opened(url) as store:
        put(store, sample())
        ((name,),) = ask("SELECT current_schema()").fetchall()
        ask(f"CREATE ROLE panel_{name}; GRANT USAGE ON SCHEMA {name} TO panel_{name}")
        try:
            ask(f"GRANT SELECT ON {', '.join(VIEWS)} TO panel_{name}")
            ask(f"SET ROLE panel_{name}")
            assert rows_of(ask, "readings")[0]["depth_m"] == 14.0
            with pytest.raises(psycopg.errors.InsufficientPrivilege):
                ask("SELECT * FROM sample")
        finally:
            ask(f"RESET ROLE; DROP OWNED BY panel_{name}; DROP ROLE panel_{name}")


def test_a_file_without_room_for_views_opens_without_them(tmp_path):
    place = tmp_path / "samples.sqlite"
    opened(place).thing.close()
    with closing(sqlite3.connect(place, isolation_level=None)) as full:
        for view in VIEWS:
            full.execute(f"DROP VIEW {view}")
        full.execute("VACUUM")
        ((pages,),) = full.execute("PRAGMA page_count").fetchall()
        full.execute(f"PRAGMA max_page_count = {pages}")
        _make_views(full)
        assert not full.in_transaction
        left = full.execute("SELECT count(*) FROM sqlite_schema WHERE type = 'view'").fetchone()[0]
        assert left < len(VIEWS)
    with opened(place) as store, asking(place) as ask:
        put(store, sample())
        assert rows_of(ask, "readings")[0]["depth_m"] == 14.0
