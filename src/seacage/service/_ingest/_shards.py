"""Which of many workers serves which cage."""

from collections.abc import Sequence
from hashlib import blake2b


def worker_of(cage: str, workers: Sequence[str]) -> str:
    """The one worker of a cage, the same in every process.

    When a worker comes or goes, only the cages that it gets or had move.

    ``workers``: the names of all workers, in any order; at least one.

    Source: Thaler & Ravishankar (1998), Using name-based mappings to increase hit rates: the
    highest random weight.
    """
    return max(workers, key=lambda worker: (_weight(cage, worker), worker))


def _weight(cage: str, worker: str) -> bytes:
    return blake2b(f"{cage}\n{worker}".encode(), digest_size=8).digest()
