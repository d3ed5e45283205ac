"""The live store: samples taken, aggregates of a year, and what a reader's connection costs.

With `--postgres URL` the same is asked of a server, in tables that are dropped again.
"""

import sys
import tempfile
import time
from collections.abc import Generator
from contextlib import closing, contextmanager, nullcontext
from datetime import UTC, datetime, timedelta
from pathlib import Path

from _timing import ONCE, print_times, seconds

from seacage.records import Sample
from seacage.service._store import _samples
from seacage.service._store._database import _postgres, _sqlite
from seacage.service._store._database._checksum import with_checksum
from seacage.service._store._database._rows import Row, row_of
from seacage.service._store._database._session import AbstractDatabase
from seacage.service._store._database._sqlite import sqlite_look
from seacage.service._store._store import Store, database_at, open_store

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)
STREAMS = [f"depth-{number}" for number in range(1, 31)]
COUNT = 300 if ONCE else 6000
YEAR = 100 if ONCE else 52_560
FEW = 10 if ONCE else 200
ROUNDS = 3

moment = NOON


def fresh(count: int) -> list[Sample]:
    """Samples that no store has: of thirty sensors, every two seconds."""
    global moment  # noqa: PLW0603
    samples: list[Sample] = []
    while len(samples) < count:
        moment += timedelta(seconds=2)
        samples += [Sample(stream=name, t=moment, values={"depth_m": 14.0}) for name in STREAMS]
    return samples[:count]


def taken(place: str) -> None:
    """Samples as they are offered: many at once, or each waiting for its commit."""
    each: dict[str, float] = {}
    with closing(open_store(place)) as store:
        for size, count in ((1000, COUNT), (30, COUNT), (1, FEW)):
            ready = [fresh(count) for _ in range(ROUNDS + 1)]
            took = seconds(lambda r=ready, n=size: offer(store, r.pop(), n), rounds=ROUNDS)
            each[f"in batches of {size}"] = took / count
    print_times("append until the commit, per sample", each)


def checked(place: str) -> None:
    """What checksums and counts of days cost of the rate at which samples are taken.

    Time of the processor, the two in turn: a disk, or a busy machine, varies by more than that.
    """
    with closing(open_store(place)) as store:
        offer(store, fresh(COUNT), 1000)
        for size in (1000, 30):
            each = dict[str, list[float]]()
            for _ in range(1 if ONCE else 5):
                for what in ("without", "with checksums and counts"):
                    with without_checks() if what == "without" else nullcontext():
                        samples, start = fresh(COUNT), time.process_time()
                        offer(store, samples, size)
                    each.setdefault(what, []).append((time.process_time() - start) / COUNT)
            print_times(
                f"append by {size}, processor time per sample", {k: min(v) for k, v in each.items()}
            )


@contextmanager
def without_checks() -> Generator[None]:
    """Rows get the same number for a checksum and no day is counted."""
    known = _sqlite.checksum, _postgres.checksum, _samples.count_new
    _sqlite.checksum = _postgres.checksum = lambda *_: 0
    _samples.count_new = lambda *_: None
    try:
        yield
    finally:
        _sqlite.checksum, _postgres.checksum, _samples.count_new = known


def offer(store: Store, samples: list[Sample], size: int) -> None:
    for first in range(0, len(samples), size):
        store.append("ace", samples[first : first + size], ingested=NOON).result()


def inserted(place: str) -> None:
    """All rows by one call, or one call for each."""
    per_row: dict[str, float] = {}
    with closing(database_at(place)) as database:
        for what, size in (("all rows at once", COUNT), ("row by row", 1)):
            ready = [
                [row_of("ice", one, NOON, {}) for one in fresh(COUNT)] for _ in range(ROUNDS + 1)
            ]
            took = seconds(lambda r=ready, n=size: insert(database, r.pop(), n), rounds=ROUNDS)
            per_row[what] = took / COUNT
    print_times("insert in one transaction, per row", per_row)


def rows(samples: list[Sample]) -> list[Row]:
    return [row_of("ice", one, NOON, {}) for one in samples]


def insert(database: AbstractDatabase, rows: list[Row], size: int) -> None:
    with database.writing() as session:
        for first in range(0, len(rows), size):
            session.insert(rows[first : first + size])


def summed_up(place: str) -> None:
    """A year of ten minutes as it is kept, against the same from samples of a day."""
    start = datetime(2024, 1, 1, tzinfo=UTC)
    t, of = int(start.timestamp()) * 1_000_000, ("old", "depth-1", "depth_m", 600)
    with closing(database_at(place)) as database, database.writing() as session:
        session.each(
            "INSERT INTO aggregate VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            [
                with_checksum("aggregate", *of, t + k * 600_000_000, 300, 14.0, 13.0, 15.0)
                for k in range(YEAR)
            ],
        )
    with closing(open_store(place)) as store:
        every_s, day = (600 if ONCE else 2), timedelta(days=1)
        samples = [
            Sample(stream="depth-1", t=start + timedelta(seconds=k), values={"depth_m": 14.0})
            for k in range(0, 86_400, every_s)
        ]
        store.append("new", samples, ingested=NOON).result()
        of = {"stream": "depth-1", "key": "depth_m", "width_s": 600, "limit": 100_000}
        kept = seconds(lambda: store.aggregates("old", **of), rounds=3) / YEAR
        made = seconds(lambda: store.aggregates("new", **of, end=start + day), rounds=3) / 144
    print_times("aggregates, per ten minutes asked for", {"kept": kept, "from samples": made})
    print(f"  a year of {YEAR:,} spans, kept: {kept * YEAR:.2f} s")


def read(place: str) -> None:
    """What each question of a page costs."""
    with closing(open_store(place)) as store:
        store.append("ace", fresh(3000), ingested=NOON).result()
        four = {"limit": 4, "newest": True}
        body = {
            "the newest of 30 streams, one query": lambda: store.latest("ace"),
            "four of each of 30 streams, 30 queries": lambda: [
                store.samples("ace", stream=name, **four) for name in STREAMS
            ],
        }
        print_times("read", {what: seconds(ask) for what, ask in body.items()})
        pooled = seconds(lambda: store.alarm_book("ace"))
        if not place.startswith("postgres"):
            opened = seconds(lambda: look(Path(place)))
            print_times(
                "the smallest question", {"connection kept": pooled, "opened for it": opened}
            )


def look(path: Path) -> None:
    with sqlite_look(path) as session:
        session.rows("SELECT book FROM alarm_book WHERE cage = 'ace'")


def all_of(place: str) -> None:
    for part in (taken, checked, inserted, read, summed_up):
        part(place)


with tempfile.TemporaryDirectory() as folder:
    print("SQLite")
    all_of(str(Path(folder, "samples.sqlite")))

if "--postgres" in sys.argv:
    import psycopg

    url = sys.argv[sys.argv.index("--postgres") + 1]
    with psycopg.connect(url, autocommit=True) as owner:
        owner.execute("CREATE SCHEMA seacage_benchmark")
        try:
            print("PostgreSQL")
            join = "&" if "?" in url else "?"
            all_of(f"{url}{join}options=-csearch_path%3Dseacage_benchmark")
        finally:
            owner.execute("DROP SCHEMA seacage_benchmark CASCADE")
