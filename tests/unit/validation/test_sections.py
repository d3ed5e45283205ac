"""The rows that need no seconds hold in every change, and the page in the docs is theirs."""

from collections import Counter
from pathlib import Path

import pytest

from validation._sections import MODULES, chosen, computed, rows_of, sections_of

PAGE = Path(__file__).parents[3] / "docs" / "validation.md"
SECONDS = {"cage_at_rest", "field", "lines_in_time", "own_cases"}
QUICK = [job for job in chosen(quick=True) if job[0] not in SECONDS]
SLOW = [job for job in chosen() if job not in QUICK]
MINUTES = (pytest.mark.slow, pytest.mark.timeout(900))
ALL = [*QUICK, *(pytest.param(*job, marks=MINUTES) for job in SLOW)]


@pytest.mark.parametrize(("module", "index"), ALL)
def test_all_rows_that_must_hold_do(module, index):
    rows, page = rows_of(module, index), PAGE.read_text("utf-8")
    assert rows
    assert [row for row in rows if row.fails] == []
    for row in rows:
        assert row.reason
        assert row.tolerance >= 0.0
        assert f"\n| {row.what} |" in page, "docs/validation.md is old: run `make validate`"
        if row.verdict != "yes":
            assert row.note, f"{row.what}: the row does not hold and does not say why"


def test_the_table_keeps_the_order_of_its_sections_and_reports_each():
    jobs = chosen(quick=True, only=["screens", "catenaries"])
    report = []
    table = computed(jobs, workers=1, report=lambda *outcome: report.append(outcome))
    assert list(table) == [sections_of(module)[index].title for module, index in jobs]
    assert [done for _, done, _ in report] == list(range(1, len(jobs) + 1))
    names = Counter(row.what for _, rows in table.values() for row in rows)
    assert names.most_common(1)[0][1] == 1


def test_every_module_of_rows_is_in_the_table():
    here = Path(sections_of.__globals__["__file__"]).parent
    written = {path.stem for path in here.glob("[a-z]*.py")}
    assert written <= set(MODULES)
