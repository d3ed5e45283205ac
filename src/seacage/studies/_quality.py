"""A page on the quality of records: for each stream what was flagged, when, by what and why."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt8

from seacage.conventions import Flag
from seacage.figures import quality_figure
from seacage.records import DEFAULT_LIMITS, Limits, Record, Verdict, alike, verdicts_on
from seacage.studies._page import Html, facts, page, picture, table, tag

_WORDS = {flag: flag.name.lower().replace("_", " ") for flag in Flag}
_TROUBLES = (Flag.FAIL, Flag.MISSING, Flag.SUSPECT)  # the gravest first
_NAMED = 3  # streams in the title; of more it says how many


def quality_page(records: Sequence[Record], limits: Limits = DEFAULT_LIMITS) -> str:
    """Return an HTML document that needs nothing beside itself.

    Parameters
    ----------
    records
        Checked streams; their flags are shown as they are.
    limits
        That they were checked with, to say which test found what.
    """
    names = [record.stream for record in records]
    few = len(names) <= _NAMED
    title = f"Quality of {', '.join(names) if few else f'{len(names)} streams'}"
    legend = tag(
        "p",
        "Suspect values are used and say so; failed and missing ones never reach a model. Raw "
        "values are kept. The flags are those of QARTOD (IOOS).",
    )
    return page(
        title,
        tag("header", tag("h1", title), tag("p", _summary(records), look="lead"), legend),
        *([_overview(records)] if len(records) > 1 else []),
        *(part for record in records for part in _stream(record, limits)),
    )


def _summary(records: Sequence[Record]) -> str:
    """What a reader in a hurry wants to know."""
    readings = sum(len(record) for record in records)
    worst = np.concatenate([_worst(record) for record in records])
    counts = {flag: int(np.sum(worst == flag)) for flag in _TROUBLES}
    flagged = sum(counts.values())
    if not flagged:
        return f"None of {readings:,} readings is flagged."
    parts = ", ".join(f"{count:,} {_WORDS[flag]}" for flag, count in counts.items() if count)
    share = _percent(flagged, readings)
    return f"{flagged:,} of {readings:,} readings are flagged ({share}): {parts}."


def _overview(records: Sequence[Record]) -> Html:
    rows: list[tuple[str, ...]] = []
    for record in records:
        worst = _worst(record)
        marked = np.flatnonzero(np.isin(worst, _TROUBLES))
        rows.append(
            (
                record.stream,
                f"{len(record):,}",
                *(f"{np.sum(worst == flag):,}" for flag in _TROUBLES),
                _percent(len(marked), len(record)),
                _when(record, int(marked[-1])) if marked.size else "–",
            )
        )
    head = ("Stream", "Readings", *(_WORDS[flag] for flag in _TROUBLES), "Flagged", "Last flagged")
    return table(head, rows, caption="Each reading once, by the worst flag of its values")


def _worst(record: Record) -> UInt8[np.ndarray, " t"]:
    """The worst flag of each reading."""
    none = np.full(len(record), Flag.GOOD, dtype=np.uint8)
    return np.max([none, *record.flags.values()], axis=0)


def _stream(record: Record, limits: Limits) -> list[Html]:
    sound = int(np.sum(~np.isin(_worst(record), _TROUBLES)))
    parts = [
        tag("h2", record.stream),
        facts(
            {
                "Numbers are": str(record.origin),
                "Time": _span(record),
                "Readings": f"{len(record):,}, of which {sound:,} carry no flag",
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
    verdicts = verdicts_on(record, limits)
    return [*parts, *_findings(record, verdicts), _counts(record), *_notes(record, verdicts)]


def _span(record: Record) -> str:
    if not len(record):
        return "no reading"
    return f"{_when(record, 0)} to {_when(record, len(record) - 1)} UTC"


def _step(record: Record) -> str:
    if len(record) < 2:
        return "–"
    seconds = np.diff(record.time) / np.timedelta64(1, "s")
    return f"{_long(float(np.median(seconds)))} (longest silence {_long(float(np.max(seconds)))})"


def _counts(record: Record) -> Html:
    shown = [flag for flag in Flag if any(np.any(f == flag) for f in record.flags.values())]
    return table(
        ("Quantity", *(_WORDS[flag] for flag in shown)),
        [
            (key, *(f"{np.sum(record.flags[key] == flag):,}" for flag in shown))
            for key in record.values
        ],
        caption="How many values have each flag",
    )


def _findings(record: Record, verdicts: Sequence[Verdict]) -> list[Html]:
    """What each test found; quantities that it found in the same readings are listed at once."""
    if not verdicts:
        return [tag("p", "No test found anything.")]

    worst_first = sorted(alike(verdicts), key=lambda same: _TROUBLES.index(same[0].flag))
    items = [_item(record, same) for same in worst_first]
    return [tag("h3", "What was flagged, when and why"), tag("ul", *items, look="found")]


def _item(record: Record, same: Sequence[Verdict]) -> Html:
    first, rows = same[0], same[0].rows
    keys = ", ".join(one.key for one in same)
    flag = tag("span", _WORDS[first.flag], look=f"flag {_WORDS[first.flag]}")
    head = tag("b", f"{first.test[0].upper()}{first.test[1:]}")
    why = first.example.split(": ", 1)[-1].rsplit(" Flagged ", 1)[0]
    return tag(
        "li",
        tag("p", head, flag, f" {len(rows):,} × {keys}"),
        tag("p", _times(record, first)),
        tag("p", f"The first: {why}", look="why"),
    )


def _times(record: Record, verdict: Verdict) -> str:
    """When a test found something, and the longest run of neighbours that it found."""
    rows = verdict.rows
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
    run = max(runs, key=len)
    if len(rows) == 1:
        return f"{_when(record, int(rows[0]))} UTC"
    span = f"{_when(record, int(rows[0]))} to {_when(record, int(rows[-1]))} UTC"
    if len(run) == 1:
        return f"{span}, each alone"
    seconds = float((record.time[run[-1]] - record.time[run[0]]) / np.timedelta64(1, "s"))
    if len(runs) == 1:
        return f"{span}, without a break for {_long(seconds)}"
    begun = _when(record, int(run[0]))
    return f"{span}, in {len(runs):,} runs; the longest, {_long(seconds)}, from {begun}"


def _when(record: Record, row: int) -> str:
    return str(record.time[row])[:16].replace("T", " ")


def _long(seconds: float) -> str:
    for unit, size in (("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2.0 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.3g} s"


def _percent(part: int, whole: int) -> str:
    return "0 %" if not part else f"{max(100.0 * part / whole, 0.01):.2g} %"


def _notes(record: Record, verdicts: Sequence[Verdict]) -> list[Html]:
    """What else the record says of itself; what the tests found is listed already."""
    examples = tuple(one.example for one in verdicts)
    notes = [note for note in record.notes if not note.startswith(examples)]
    if not notes:
        return []
    return [
        tag("h3", "What else the record says of itself"),
        tag("ul", *(tag("li", note) for note in notes)),
    ]
