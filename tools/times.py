"""Prints where the tests' processor time goes; a plugin of pytest: `-p tools.times`.

Processor time, of a worker and of its children, says the same on a busy machine as on an idle
one, where `--durations` tells how long others were served. What a fixture takes counts for the
test that asks for it first.
"""

import resource
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

SLOWEST = 60
clock = {"last": 0.0, "collected": 0.0}  # of this process, which has one of each hook


def spent() -> float:
    """Processor time of this process and of its finished children [s]."""
    used = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in used)


def pytest_collection_finish() -> None:
    """Begin to count."""
    clock["last"] = clock["collected"] = spent()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    """Write into each report what was spent since the one before, and once what went before."""
    report = yield
    now = spent()
    report.spent, report.collected = now - clock["last"], clock["collected"]
    clock.update(last=now, collected=0.0)
    return report


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Print the sums by folder and by file, and the slowest tests."""
    kinds = terminalreporter.stats.values()
    reports = [one for kind in kinds for one in kind if hasattr(one, "spent")]
    tests, files, rooms = Counter[str](), Counter[str](), Counter[str]()
    for report in reports:
        path = Path(report.nodeid.partition("::")[0])
        for sums, name in ((tests, report.nodeid), (files, path), (rooms, path.parent)):
            sums[str(name)] += report.spent
    write = terminalreporter.write_line
    terminalreporter.section("processor time")
    write(f"{sum(tests.values()) / 60.0:.1f} core-minutes in tests")
    for report in reports:
        if report.collected:
            write(f"{report.collected:.1f} s to start and to collect, in each worker")
    for title, sums, most in (
        ("folders", rooms, 99),
        ("files", files, 60),
        ("tests", tests, SLOWEST),
    ):
        terminalreporter.section(title)
        for name, seconds in sums.most_common(most):
            write(f"{seconds:8.2f} s  {name}")
