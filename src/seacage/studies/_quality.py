"""A page on the quality of records: for each stream what was flagged, when, by what and why."""

from collections.abc import Sequence

import numpy as np

from seacage.conventions import Flag
from seacage.figures import quality_figure
from seacage.records import DEFAULT_LIMITS, Limits, Record, Verdict, verdicts_on
from seacage.studies._page import Html, facts, page, picture, table, tag

_WORDS = {flag: flag.name.lower().replace("_", " ") for flag in Flag}


def quality_page(records: Sequence[Record], limits: Limits = DEFAULT_LIMITS) -> str:
    """Return an HTML document that needs nothing beside itself.

    Parameters
    ----------
    records
        Checked streams; their flags are shown as they are.
    limits
        That they were checked with, to say which test found what.
    """
    title = f"Quality of {', '.join(record.stream for record in records)}"
    lead = tag(
        "p",
        "Flags are those of QARTOD (IOOS): suspect values are used and say so, failed and "
        "missing ones never reach a model. Raw values are kept.",
        look="lead",
    )
    return page(
        title,
        tag("header", tag("h1", title), lead),
        *(part for record in records for part in _stream(record, limits)),
    )


def _stream(record: Record, limits: Limits) -> list[Html]:
    verdicts = verdicts_on(record, limits)
    worst = np.max(list(record.flags.values()), axis=0, initial=0)
    sound = int(np.sum(worst <= Flag.NOT_EVALUATED))
    parts = [
        tag("h2", record.stream),
        facts(
            {
                "Numbers are": str(record.origin),
                "Time": _span(record),
                "Readings": f"{len(record)}, of which {sound} carry no flag",
                "Usual step": _step(record),
            }
        ),
    ]
    if len(record):
        parts.append(
            picture(
                quality_figure(record),
                caption="What came, and where it is suspect, failed or missing. A failed value "
                "outside the picture stands at its edge.",
                alternative=f"{record.stream} over time with its quality flags",
                look="wide",
            )
        )
    parts += [_counts(record), *_found(record, verdicts), *_notes(record, verdicts)]
    return parts


def _span(record: Record) -> str:
    if not len(record):
        return "no reading"
    first, last = (str(t)[:16].replace("T", " ") for t in record.time[[0, -1]])
    return f"{first} to {last} UTC"


def _step(record: Record) -> str:
    if len(record) < 2:
        return "–"
    seconds = np.diff(record.time) / np.timedelta64(1, "s")
    return f"{np.median(seconds):g} s (longest silence {np.max(seconds) / 3600.0:.3g} h)"


def _counts(record: Record) -> Html:
    shown = [flag for flag in Flag if any(np.any(f == flag) for f in record.flags.values())]
    return table(
        ("Quantity", *(_WORDS[flag] for flag in shown)),
        [
            (f"{key}", *(f"{np.sum(record.flags[key] == flag)}" for flag in shown))
            for key in record.values
        ],
        caption="How many values have each flag",
    )


def _found(record: Record, verdicts: Sequence[Verdict]) -> list[Html]:
    if not verdicts:
        return [tag("p", "No test found anything.")]
    rows = [
        (
            one.test,
            one.key,
            _WORDS[one.flag],
            str(len(one.rows)),
            _when(record, int(one.rows[0])),
            _when(record, int(one.rows[-1])),
            _longest(record, one),
            one.example.split(": ", 1)[-1],
        )
        for one in verdicts
    ]
    head = ("Test", "Quantity", "Flag", "Values", "First", "Last", "Longest run", "Why, the first")
    return [table(head, rows, caption="What each test found, when and why")]


def _when(record: Record, row: int) -> str:
    return str(record.time[row])[:16].replace("T", " ")


def _longest(record: Record, verdict: Verdict) -> str:
    """The most neighbours in a row that a test found, and how long they lasted."""
    runs = np.split(verdict.rows, np.flatnonzero(np.diff(verdict.rows) > 1) + 1)
    run = max(runs, key=len)
    hours = (record.time[run[-1]] - record.time[run[0]]) / np.timedelta64(1, "h")
    return f"{len(run)} from {_when(record, int(run[0]))}, {hours:.3g} h"


def _notes(record: Record, verdicts: Sequence[Verdict]) -> list[Html]:
    """What the reader noticed of the file; what the tests found is told already."""
    told = tuple(one.example for one in verdicts)
    notes = [note for note in record.notes if not note.startswith(told)]
    if not notes:
        return []
    return [tag("h3", "What the reader noticed"), tag("ul", *(tag("li", note) for note in notes))]
