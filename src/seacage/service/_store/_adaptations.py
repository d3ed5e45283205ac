"""How far the intervals of a cage's twin were adapted to its sensors, and from when on."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from seacage.service._store._database._rows import microseconds, moment_of
from seacage.service._store._database._session import AbstractSession

_KEEP = """
INSERT INTO adaptation VALUES (?, ?, ?, ?)
ON CONFLICT (cage, t) DO UPDATE SET factors = excluded.factors, crc = excluded.crc"""
_CUT = "DELETE FROM adaptation WHERE cage = ? AND t >= ?"
_AT = "SELECT t, factors, crc FROM adaptation WHERE cage = ? AND t <= ? ORDER BY t DESC LIMIT ?"
_EVER = "SELECT count(*) FROM adaptation WHERE cage = ?"
_BY_0_1_0 = "SELECT factors, crc FROM adapted WHERE cage = ?"
_REFOLD = "SELECT t, touched, crc FROM refold WHERE cage = ?"
_KEEP_REFOLD = """
INSERT INTO refold VALUES (?, ?, ?, ?) ON CONFLICT (cage) DO UPDATE SET
    t = excluded.t, touched = excluded.touched, crc = excluded.crc"""
_FOLDED = "DELETE FROM refold WHERE cage = ? AND t >= ? AND touched = ?"


@dataclass(frozen=True, slots=True, kw_only=True)
class Adaptation:
    """Factors of the intervals, as the twin writes them."""

    t: datetime | None  # from when on they held; None where it is not known, as in a store of 0.1.0
    factors: str  # JSON


@dataclass(frozen=True, slots=True, kw_only=True)
class Refold:
    """What has to be adapted anew, as samples came too late."""

    t: datetime  # from when on
    touched: datetime  # when the last of them came


def keep_adaptations(
    session: AbstractSession,
    cage: str,
    kept: Sequence[Adaptation],
    refold: Refold | None,
    start: datetime | None,
) -> None:
    """Keep factors of several times; of a refold, in place of those that were there."""
    if refold is not None:
        session.rows(_CUT, (cage, microseconds(start or refold.t)))
        session.rows(_FOLDED, (cage, microseconds(refold.t), microseconds(refold.touched)))
    rows = [(cage, microseconds(one.t), one.factors) for one in kept if one.t is not None]
    session.keep("adaptation", _KEEP, *rows)


def cut_adaptations(session: AbstractSession, cage: str, start: datetime) -> None:
    """Delete the factors of a time and of later ones."""
    session.rows(_CUT, (cage, microseconds(start)))


def adaptation_at(session: AbstractSession, cage: str, at: datetime) -> Adaptation | None:
    """Read the factors in force at a time; None where none were kept."""
    for t, factors in session.intact("adaptation", _AT, (cage, microseconds(at)), limit=1):
        return Adaptation(t=moment_of(t), factors=factors)
    ((count,),) = session.rows(_EVER, (cage,))
    for (factors,) in [] if count else session.intact("adapted", _BY_0_1_0, (cage,)):
        return Adaptation(t=None, factors=factors)
    return None


def refold_of(session: AbstractSession, cage: str) -> Refold | None:
    """Read what has to be adapted anew; None where nothing has."""
    for t, touched in session.intact("refold", _REFOLD, (cage,)):
        return Refold(t=moment_of(t), touched=moment_of(touched))
    return None


def ask_refold(session: AbstractSession, cage: str, refold: Refold) -> None:
    """Have intervals adapted anew from a time on, or from the earlier one that was asked for."""
    pending = refold_of(session, cage)
    t = refold.t if pending is None else min(pending.t, refold.t)
    row = (cage, microseconds(t), microseconds(refold.touched))
    session.keep("refold", _KEEP_REFOLD, row)
