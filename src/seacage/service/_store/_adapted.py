"""What a cage's twin has learned from its sensors since it was trained, kept for a restart."""

from seacage.service._store._session import AbstractSession

_KEEP = """
INSERT INTO adapted VALUES (?, ?) ON CONFLICT (cage) DO UPDATE SET factors = excluded.factors"""


def keep_adapted(session: AbstractSession, cage: str, factors: str) -> None:
    """Put the factors of a cage, as JSON, in place of those before."""
    session.rows(_KEEP, (cage, factors))


def adapted(session: AbstractSession, cage: str) -> str | None:
    """Read the factors of a cage; None where none were kept."""
    rows = session.rows("SELECT factors FROM adapted WHERE cage = ?", (cage,))
    return rows[0][0] if rows else None
