"""Which sections there are, in the order of the table, and how they are computed."""

import importlib
import importlib.util
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed

from validation._row import Row, Section
from validation._table import Table

MODULES = (
    "catenaries",
    "screens",
    "panels",
    "water",
    "structure",
    "second_solver",
    "mooring",
    "mooring_peers",
    "cuts",
    "lines_in_time",
    "cage_at_rest",
    "field",
    "own_cases",
    "cage_in_time",
)
"""Modules of this folder, each with a tuple ``SECTIONS``."""

Report = Callable[[str, int, int], None]
"""Called after each section with its title, how many are done and how many there are."""


def sections_of(module: str) -> tuple[Section, ...]:
    """The sections of a module of this folder; none where it has not been written."""
    if importlib.util.find_spec(f"validation.{module}") is None:
        return ()
    return importlib.import_module(f"validation.{module}").SECTIONS


def chosen(*, quick: bool = False, only: Sequence[str] = ()) -> list[tuple[str, int]]:
    """Module and index of the sections to compute: the quick ones, or those of some modules."""
    return [
        (module, index)
        for module in MODULES
        if not only or module in only
        for index, section in enumerate(sections_of(module))
        if not (quick and section.slow)
    ]


def rows_of(module: str, index: int) -> list[Row]:
    """The rows of one section, computed."""
    return list(sections_of(module)[index].rows())


def computed(jobs: Sequence[tuple[str, int]], *, workers: int = 1, report: Report) -> Table:
    """The table of some sections, shared among processes."""
    found: dict[tuple[str, int], list[Row]] = {}
    with ProcessPoolExecutor(workers) as pool:
        # the slow ones first, so that no worker is left alone with one
        order = sorted(jobs, key=lambda job: not sections_of(job[0])[job[1]].slow)
        running = {pool.submit(rows_of, *job): job for job in order}
        for done, future in enumerate(as_completed(running), 1):
            module, index = job = running[future]
            found[job] = future.result()
            report(sections_of(module)[index].title, done, len(jobs))
    table: dict[str, tuple[Section, list[Row]]] = {}
    for module, index in jobs:
        section = sections_of(module)[index]
        # the quick and the slow rows of one title stand together, under the first one's sentence
        first, before = table.get(section.title, (section, []))
        table[section.title] = (first, [*before, *found[module, index]])
    return table


def failures(table: Table) -> list[Row]:
    """The rows that must hold and do not."""
    return [row for _, rows in table.values() for row in rows if row.fails]
