"""The store on a server: shared by workers, parted by month, and reached again."""

import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import psycopg
import pytest

from seacage.service._store._store import StoreError, open_store
from stores import put, sample, schema

A_DAY = 60 * 24


@pytest.fixture
def url(postgres):
    with schema(postgres) as one:
        yield one


@pytest.fixture
def pair(url):
    """Two workers on one database."""
    stores = [open_store(url), open_store(url)]
    yield stores
    for store in stores:
        store.close()


def rows_of(url, sql):
    with psycopg.connect(url, autocommit=True) as connection:
        cursor = connection.execute(sql)
        return cursor.fetchall() if cursor.description else []


def test_each_month_has_its_partition(url, pair):
    put(pair[0], sample(), sample(35 * A_DAY), sample(-18_000 * A_DAY))
    tables = "SELECT tablename FROM pg_tables WHERE tablename LIKE 'sample_%' AND schemaname = "
    names = {name for (name,) in rows_of(url, tables + "current_schema()")}
    assert names == {"sample_2020_02", "sample_2020_03", "sample_early"}
    assert rows_of(url, "SELECT count(*) FROM sample_2020_02") == [(1,)]


def test_times_are_found_by_brin(url, pair):
    put(pair[0], sample())
    (kind,) = rows_of(
        url,
        "SELECT indexdef FROM pg_indexes WHERE tablename = 'sample_2020_02' "
        "AND indexdef LIKE '%brin%' AND schemaname = current_schema()",
    )
    assert "(t)" in kind[0]


def test_two_workers_with_the_same_samples_store_each_once(pair):
    months = [sample(15 * A_DAY * k + j) for k in range(6) for j in range(20)]
    messages = {}

    def send(worker, order):
        messages[worker] = sum(put(pair[worker], *order))

    threads = [
        threading.Thread(target=send, args=(worker, months[:: 1 - 2 * worker]))
        for worker in range(2)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sum(messages.values()) == len(months)
    assert pair[0].samples("ace", limit=999) == months


def test_many_may_make_the_tables_at_once(url):
    stores = []
    threads = [threading.Thread(target=lambda: stores.append(open_store(url))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for store in stores:
        store.close()
    assert len(stores) == 4


def test_a_store_opens_beside_one_that_is_writing(url):
    open_store(url).close()
    with ThreadPoolExecutor() as pool, psycopg.connect(url) as writing:
        writing.execute("LOCK TABLE sample, mark, journal IN ROW EXCLUSIVE MODE")
        pool.submit(open_store, url).result(timeout=20.0).close()


def test_a_connection_that_is_cut_is_made_again(url, pair):
    store = pair[0]
    put(store, sample())
    store.samples("ace", limit=9)
    rows_of(
        url,
        "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'seacage'",
    )
    with pytest.raises(StoreError, match="postgres on"):
        put(store, sample(1))
    with pytest.raises(StoreError, match="cannot be read"):
        store.samples("ace", limit=9)
    end = time.monotonic() + 20
    while store.fault and time.monotonic() < end:  # nobody sends anything
        time.sleep(0.05)
    assert store.fault is None
    assert put(store, sample(1)) == (True,)
    assert store.samples("ace", limit=9) == [sample(), sample(1)]


def test_a_connection_that_a_cut_left_in_its_pipeline_is_made_again(pair):
    store = pair[0]
    store.claim("ace")
    left = store._database._writer

    def cut(session):
        left.pgconn.enter_pipeline_mode()
        left.pgconn.send_query_params(b"SELECT 1", None)

    with pytest.raises(StoreError, match="pipeline mode"):
        store._writer.ask(cut).result(timeout=20)
    assert not left.closed
    assert put(store, sample()) == (True,)
    assert left.closed
    with pytest.raises(StoreError, match="another process"):
        pair[1].claim("ace")


def test_workers_serve_cages_of_their_own(pair, monkeypatch):
    monkeypatch.setattr("seacage.service._store._store._PATIENCE_S", 0.3)
    for store, cage in zip(pair, ("ace", "ice"), strict=True):
        store.claim(cage)
    with pytest.raises(StoreError, match="another process"):
        pair[1].claim("ace")


def test_a_cage_that_went_to_another_while_the_server_was_away_stays_there(url, pair, monkeypatch):
    here, there = pair
    here.claim("ace")
    # Between the cut and here's next attempt, there is the one who asks.
    monkeypatch.setattr(here._database, "_tried", time.monotonic() + 2.0)
    writer = here._database._writer.info.backend_pid
    rows_of(url, f"SELECT pg_terminate_backend({writer})")
    there.claim("ace")
    for _ in range(2):
        with pytest.raises(StoreError, match="ace went to another process"):
            put_until_cut(here)
    assert put(there, sample()) == (True,)
    there.close()
    end = time.monotonic() + 20
    while here.fault and time.monotonic() < end:  # nobody sends anything
        time.sleep(0.05)
    assert put(here, sample(1)) == (True,)


def put_until_cut(store):
    """The first attempts only find that the connection is gone: a busy server ends it late."""
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        try:
            put(store, sample(2))
        except StoreError as error:
            if "went to" in str(error):
                raise


def test_an_opening_that_fails_leaves_no_connection(url):
    here = "SELECT count(*) FROM pg_stat_activity WHERE application_name = 'seacage'"
    before = rows_of(url, here)
    with pytest.raises(StoreError, match="read-only transaction") as refused:
        open_store(f"{url}%20-cdefault_transaction_read_only%3Don")
    end = time.monotonic() + 5
    while rows_of(url, here) != before and time.monotonic() < end:
        time.sleep(0.05)
    assert rows_of(url, here) == before
    assert refused.value  # which holds all that the attempt made, so that nothing closes by itself


def test_an_answered_sample_is_on_disk_whatever_the_servers_default(url, pair):
    with pair[0]._database.writing() as session:
        assert session.rows("SHOW synchronous_commit") == [("on",)]


def test_a_server_that_does_not_answer_is_named_without_the_password():
    with pytest.raises(StoreError, match=r"farm on .* does not open") as refused:
        open_store("postgresql://keeper:secret@127.0.0.1:1/farm")
    assert "secret" not in str(refused.value)


def test_an_address_that_is_none_is_refused():
    with pytest.raises(StoreError, match="does not open"):
        open_store("postgresql://host/name?colour=blue")


def test_without_the_driver_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(StoreError, match=r"seacage\[postgres\]"):
        open_store("postgresql://127.0.0.1/farm")


def test_a_file_needs_no_driver_of_a_server(tmp_path):
    script = (
        "import sys; from pathlib import Path; "
        "from seacage.service._store._store import open_store; "
        f"open_store(Path({str(tmp_path)!r}, 's.sqlite')).close(); print('psycopg' in sys.modules)"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], check=True, capture_output=True, text=True
    )
    assert result.stdout.strip() == "False"
