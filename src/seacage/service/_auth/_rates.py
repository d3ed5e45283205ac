"""How often somebody may ask: a bucket that fills with time, one per asker."""

from collections import OrderedDict

_MOST_ASKERS = 10_000


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
