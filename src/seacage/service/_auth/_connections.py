"""What one asker may hold: open connections, and rows of long answers in the making."""

import asyncio
from collections import Counter
from typing import Any

import structlog
from fastapi import HTTPException
from starlette.requests import HTTPConnection

from seacage.service._auth._limits import Limits
from seacage.service._live._metrics import Metrics

_OTHER_FILES = 256  # that a process has open beside its connections, and those about to be counted
_LOOKS, _PAUSE_S = 10, 0.1  # whoever asks for one answer after the other meets the one before
_LATER_S = 5  # a long answer takes about as long
_log = structlog.get_logger(__name__)


class Connections:
    """The connections of a service, those of strangers apart from those of known tokens.

    A connection is a stranger's until a token or a session came over it. Strangers hold half of
    all at most, and the oldest gives way to the newest: half a request, sent a thousand times,
    keeps nobody out who sends a whole one.

    ``limits``: how many in all, of an address and of a token. ``metrics``: where it is counted what
    was dropped.
    """

    def __init__(self, limits: Limits, metrics: Metrics) -> None:
        self._limits, self._dropped = limits, metrics.dropped
        self._most = min(limits.connections, _descriptors())
        self._strangers, self._known = dict[Any, str](), dict[Any, str]()

    def came(self, one: Any, address: str) -> None:
        """Count uvicorn's protocol as an address's; an empty one is a proxy's, for many others."""
        self.forget(one)
        self._strangers[one] = address
        if address:
            self._limit(self._strangers, address, self._limits.connections_per_address)
        if 2 * len(self._strangers) > self._most:
            self.drop(next(iter(self._strangers)), "too many strangers")
        elif len(self._strangers) + len(self._known) > self._most:
            ((token, count),) = Counter(self._known.values()).most_common(1)
            self._limit(self._known, token, count - 1)

    def asks(self, connection: HTTPConnection, source: str) -> None:
        """Count a connection that a proxy has brought as of the address that it names."""
        one = connection.scope.get("state", {}).get("connection")
        open_still = one in self._strangers or one in self._known
        if open_still and one.client and one.client[0] != source:
            self.came(one, source)

    def knows(self, connection: HTTPConnection, token: str) -> None:
        """Count a connection as of the token that came over it, by its id."""
        one = connection.scope.get("state", {}).get("connection")
        if self._strangers.pop(one, None) is not None:
            self._known[one] = token
            self._limit(self._known, token, self._limits.connections_per_token)

    def forget(self, one: Any) -> None:
        """Forget a connection that has ended."""
        self._strangers.pop(one, None)
        self._known.pop(one, None)

    def drop(self, one: Any, why: str) -> None:
        """End a connection at once."""
        self.forget(one)
        self._dropped.labels(why).inc()
        _log.warning("connection dropped", why=why, address=one.client and one.client[0])
        one.transport.abort()

    def _limit(self, held: dict[Any, str], asker: str, most: int) -> None:
        own = [one for one, of in held.items() if of == asker]
        for one in own[: max(0, len(own) - most)]:
            self.drop(one, "too many of one asker")


def _descriptors() -> int:
    import resource  # which Windows lacks

    limit, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return 1 << 20 if limit == resource.RLIM_INFINITY else max(16, limit - _OTHER_FILES)


class Reads:
    """A budget of rows for the answers that are being made: their memory and time go with these.

    ``rows`` and ``rows_per_token``: that may be in the making at one time, of all and of one token.
    """

    def __init__(self, *, rows: int, rows_per_token: int) -> None:
        self._most, self._most_per_token = rows, rows_per_token
        self._taken = Counter[str]()

    async def take(self, token: str, rows: int) -> None:
        """Take rows out of the budget for a while; wait a moment where it is used up.

        Raises HTTPException: 429, with the time to wait.
        """
        mine = False
        for _ in range(_LOOKS):
            mine = self._taken[token] + rows > self._most_per_token
            if not mine and self._taken.total() + rows <= self._most:
                self._taken[token] += rows
                return
            await asyncio.sleep(_PAUSE_S)
        raise HTTPException(
            429,
            f"Answers for {'this token' if mine else 'others'} are still being made, and {rows} "
            f"rows more are too many at a time. Ask again in {_LATER_S} s, or for fewer rows.",
            {"Retry-After": str(_LATER_S)},
        )

    def give_back(self, token: str, rows: int) -> None:
        """Give rows back, once their answer has gone or its reader has."""
        self._taken = self._taken - Counter({token: rows})  # which forgets a token at 0
