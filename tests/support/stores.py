"""Places for a store of one's own, in a folder or in a schema of a server, and samples for it."""

import itertools
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import UTC, datetime, timedelta
from urllib.parse import quote

import psycopg
from psycopg.conninfo import conninfo_to_dict

from seacage.records import Sample
from seacage.service._store._store import open_store

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)

_numbers = itertools.count()


def sample(minutes=0, metres=14.0, stream="depth-1", **rest):
    t = NOON + timedelta(minutes=minutes)
    return Sample(stream=stream, t=t, values={"depth_m": metres}, **rest)


def put(store, *samples, cage="ace", limits=None, ingested=NOON):
    """Store samples, with their own flags or checked by limits; whether each was new."""
    future = store.append(cage, samples, ingested=ingested, limits=limits)
    return future.result(timeout=20).new


def opened(path):
    return closing(open_store(path))


@contextmanager
def schema(address: str) -> Iterator[str]:
    """Lend an empty schema of a server, as the URL of a store."""
    name = f"store_{next(_numbers)}"
    parts = conninfo_to_dict(address)
    with psycopg.connect(address, autocommit=True) as owner:
        owner.execute(f"CREATE SCHEMA {name}")
        try:
            yield (
                f"postgresql://{parts['user']}@/{parts['dbname']}?host={quote(parts['host'], '')}"
                f"&options=-csearch_path%3D{name}"
            )
        finally:
            owner.execute("SET client_min_messages = error")
            owner.execute(f"DROP SCHEMA {name} CASCADE")
