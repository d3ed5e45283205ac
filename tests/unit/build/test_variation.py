"""Every test runs in `.ci/run`, and `make test` under one variation after another."""

import itertools
import re
from pathlib import Path

import pytest
from _pytest.mark.expression import Expression

from collection import MARKS, shuffle
from tools.variation import in_turn, variations

ROOT = Path(__file__).parents[3]
ALL = ["x86-64-v4", "x86-64-v3", "x86-64-v2"]


def test_only_what_the_machine_can_run_is_varied() -> None:
    assert len(variations(ALL, 4)) == 5 + 3 + 2 + 1
    haswell = variations(ALL, 3)
    assert "OPENBLAS_CORETYPE=Zen" in haswell
    assert "OPENBLAS_CORETYPE=SkylakeX" not in haswell
    assert "SEACAGE_KERNEL=x86-64-v4" not in haswell
    assert "SEACAGE_KERNEL=x86-64-v3" in haswell
    other = variations(["native"], 0)
    assert not [one for one in other if "CORETYPE" in one]
    assert not [one for one in other if "KERNEL" in one]


def test_each_has_its_turn() -> None:
    found = variations(ALL, 4)
    turns = [in_turn(found, turn) for turn in range(1000, 1000 + len(found))]
    kinds = {re.sub(r"ORDER=\d+", "ORDER=random", turn) for turn in turns}
    assert kinds == set(found)


def test_an_order_is_random_but_the_same_for_all_workers(request: pytest.FixtureRequest) -> None:
    items = list(request.session.items)
    first, again, other = list(items), list(items), list(items)
    shuffle(first, "1")
    shuffle(again, "1")
    shuffle(other, "2")
    assert first == again
    assert sorted(first, key=id) == sorted(items, key=id)
    assert len(items) < 5 or first != other
    files = [item.path for item in first]
    assert sum(a != b for a, b in itertools.pairwise(files)) == len(set(files)) - 1


def expressions() -> list[Expression]:
    """Of `make test` and `make test-rest`."""
    text = (ROOT / "Makefile").read_text()
    fast = re.search(r"^FAST := (.*)$", text, re.MULTILINE)
    assert fast
    return [
        Expression.compile(re.sub(r"\$\(FAST\)", fast[1], found))
        for target in ("test", "test-rest")
        for found in re.findall(
            rf'^{target}:[^#]*##.*\n(?:\t.*\n)*?\t.*-m "(.*)"', text, re.MULTILINE
        )
    ]


def test_every_test_runs_in_ci_once(pytestconfig: pytest.Config) -> None:
    runs = (ROOT / ".ci/run").read_text()
    assert re.search(r"^env \$variation make test$", runs, re.MULTILINE)
    assert re.search(r"^make test-rest$", runs, re.MULTILINE)
    both = expressions()
    assert len(both) == 2
    for name, marks in pytestconfig.stash[MARKS].items():
        chosen = [one.evaluate(lambda mark, **_: mark in marks) for one in both]  # noqa: B023
        assert sum(chosen) == 1, name


def test_no_test_file_lies_where_none_is_looked_for(pytestconfig: pytest.Config) -> None:
    known = {Path(name.partition("::")[0]) for name in pytestconfig.stash[MARKS]}
    found = {path.relative_to(ROOT) for path in (ROOT / "tests").rglob("test_*.py")}
    empty = {path for path in found - known if "def test_" in (ROOT / path).read_text()}
    # A developer who names files collects those alone.
    assert not empty or pytestconfig.args != pytestconfig.getini("testpaths")
