"""How every benchmark measures and prints."""

import sys
import time
from collections.abc import Callable, Mapping

ONCE = "--once" in sys.argv[1:]
"""Do the least that runs every line: CI's way."""


def seconds(work: Callable[[], object], *, rounds: int = 5) -> float:
    """The quickest of several rounds after a first, unmeasured one; quick is least disturbed."""
    if not ONCE:
        work()
    return min(_once(work) for _ in range(1 if ONCE else rounds))


def print_times(title: str, measured: Mapping[str, float]) -> None:
    """One table: each time, and how many times the first one it is."""
    print(title)
    first = next(iter(measured.values()))
    for name, taken in measured.items():
        print(f"  {name:<48}{1e3 * taken:12.3f} ms{taken / first:10.2f} ×")


def _once(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start
