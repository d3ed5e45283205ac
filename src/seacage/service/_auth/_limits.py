"""How much one asker may ask, and how often: a bucket that fills with time, one per asker."""

from collections import OrderedDict
from typing import Annotated

from pydantic import Field

from seacage.service._schemas._base import AbstractSection

Origin = Annotated[str, Field(pattern=r"^https?://[A-Za-z0-9.\-\[\]:]+$", max_length=300)]
_MOST_ASKERS = 10_000


class Limits(AbstractSection):
    """The section ``[limits]``; what comes beyond a limit is answered 413 or 429."""

    # Of one token, in the long run and at once
    requests_per_s: float = Field(default=200.0, gt=0.0, le=1e6)
    burst: float = Field(default=1000.0, ge=1.0, le=1e6)
    # Of one address whose token is not known, so that nobody guesses for long
    refusals_per_s: float = Field(default=2.0, gt=0.0, le=1e6)
    refusal_burst: float = Field(default=50.0, ge=1.0, le=1e6)
    # Rows of long answers (histories, lists of samples, downloads) that are in the making at one
    # time, in all and for one token; the longest answer has 10,000
    read_rows: int = Field(default=20_000, ge=10_000, le=10_000_000)
    read_rows_per_token: int = Field(default=10_000, ge=10_000, le=10_000_000)
    body_bytes: int = Field(default=1_000_000, ge=1000, le=100_000_000)  # of one request [bytes]
    # Open live connections, in all and of one token
    live_clients: int = Field(default=1000, ge=1, le=100_000)
    live_per_token: int = Field(default=250, ge=1, le=100_000)
    # Open connections: in all, as far as the system's limit of open files lets; of one address
    # before a token came over them; and of one token
    connections: int = Field(default=4000, ge=10, le=100_000)
    connections_per_address: int = Field(default=256, ge=1, le=100_000)
    connections_per_token: int = Field(default=1000, ge=1, le=100_000)
    # How long a request's headers and then its body may take [s]
    headers_s: float = Field(default=10.0, gt=0.0, le=3600.0)
    body_s: float = Field(default=60.0, gt=0.0, le=3600.0)
    # How long a page stays signed in after it was last open [s], and how many of one token
    session_s: float = Field(default=43_200.0, ge=60.0, le=2_592_000.0)
    sessions_per_token: int = Field(default=50, ge=1, le=1000)
    # Pages from elsewhere that may open a live connection, as ``https://farm.example``
    origins: tuple[Origin, ...] = Field(default=(), max_length=100)


class Rates:
    """Token buckets of many askers; those that asked longest ago are forgotten first.

    ``per_s``: how quickly a bucket fills [1/s]. ``burst``: how much it holds [-].
    """

    def __init__(self, *, per_s: float, burst: float) -> None:
        self._per_s, self._burst = per_s, burst
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def wait_s(self, asker: str, now: float) -> float:
        """Take one from the bucket; how long to wait [s] where it is empty, else 0.

        ``asker``: whose bucket. ``now``: on a clock that never goes back [s].
        """
        held, since = self._buckets.get(asker, (self._burst, now))
        held = min(self._burst, held + (now - since) * self._per_s)
        wait_s = 0.0 if held >= 1.0 else (1.0 - held) / self._per_s
        self._buckets[asker] = (held - (not wait_s), now)
        self._buckets.move_to_end(asker)
        if len(self._buckets) > _MOST_ASKERS:
            self._buckets.popitem(last=False)
        return wait_s
