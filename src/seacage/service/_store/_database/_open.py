"""Which database a store lies in, by the place that it is given."""

from collections.abc import Generator
from contextlib import closing, contextmanager
from pathlib import Path

from seacage.service._store._database._session import AbstractDatabase, AbstractSession
from seacage.service._store._database._sqlite import SqliteDatabase, sqlite_look


def database_at(place: Path | str) -> AbstractDatabase:
    """Open a database to write in, made where there is none."""
    if _is_server(place):
        from seacage.service._store._database._postgres import PostgresDatabase

        return PostgresDatabase(str(place))
    return SqliteDatabase(Path(place))


@contextmanager
def look_into(place: Path | str) -> Generator[AbstractSession]:
    """Read one moment of a store that a service may be writing.

    ``place``: as for ``open_store``, but there already.

    Raises StoreError: it cannot be read.
    """
    if _is_server(place):
        with closing(database_at(place)) as database, database.reading() as session:
            yield session
    else:
        with sqlite_look(Path(place)) as session:
            yield session


def _is_server(place: Path | str) -> bool:
    return isinstance(place, str) and place.startswith(("postgresql://", "postgres://"))
