"""A page on the quality of records: for each stream what was flagged, when, by what and why."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt8

from seacage.conventions import Flag
from seacage.figures import quality_figure
from seacage.records import DEFAULT_LIMITS, Limits, Record, Verdict, alike, verdicts_on
from seacage.studies._page import render

_WORDS = {flag: flag.name.lower().replace("_", " ") for flag in Flag}
_TROUBLES = (Flag.FAIL, Flag.MISSING, Flag.SUSPECT)  # the gravest first
_NAMED = 3  # streams in the title; of more it says how many


def quality_page(records: Sequence[Record], limits: Limits = DEFAULT_LIMITS) -> str:
    """Return an HTML document that needs nothing beside itself.

    ``records``: checked streams; their flags are shown as they are. ``limits``: that they were
    checked with, to say which test found what.
    """
    names = [record.stream for record in records]
    few = len(names) <= _NAMED
    return render(
        "quality.html",
        title=f"Quality of {', '.join(names) if few else f'{len(names)} streams'}",
        summary=_summary(records),
        troubles=[_WORDS[flag] for flag in _TROUBLES],
        streams=[_stream(record, limits) for record in records],
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


def _stream(record: Record, limits: Limits) -> dict[str, object]:
    """Values of a stream's section."""
    worst = _worst(record)
    marked = np.flatnonzero(np.isin(worst, _TROUBLES))
    verdicts = verdicts_on(record, limits)
    worst_first = sorted(alike(verdicts), key=lambda same: _TROUBLES.index(same[0].flag))
    examples = tuple(one.example for one in verdicts)
    sound = len(record) - len(marked)
    return {
        "name": record.stream,
        "readings": len(record),
        "counts": [int(np.sum(worst == flag)) for flag in _TROUBLES],
        "flagged": _percent(len(marked), len(record)),
        "last": _when(record, int(marked[-1])) if marked.size else "–",
        "about": {
            "Numbers are": str(record.origin),
            "Time": _span(record),
            "Readings": f"{len(record):,}, of which {sound:,} carry no flag",
            "Usual step": _step(record),
        },
        "picture": quality_figure(record) if len(record) else None,
        "findings": [_finding(record, same) for same in worst_first],
        "shown": {
            _WORDS[flag]: flag
            for flag in Flag
            if any(np.any(flags == flag) for flags in record.flags.values())
        },
        "quantities": list(record.values),
        "flags": record.flags,
        # What the tests found is listed already.
        "notes": [note for note in record.notes if not note.startswith(examples)],
    }


def _worst(record: Record) -> UInt8[np.ndarray, " t"]:
    """The worst flag of each reading."""
    none = np.full(len(record), Flag.GOOD, dtype=np.uint8)
    return np.max([none, *record.flags.values()], axis=0)


def _span(record: Record) -> str:
    if not len(record):
        return "no reading"
    return f"{_when(record, 0)} to {_when(record, len(record) - 1)} UTC"


def _step(record: Record) -> str:
    if len(record) < 2:
        return "–"
    seconds = np.diff(record.time) / np.timedelta64(1, "s")
    return f"{_long(float(np.median(seconds)))} (longest silence {_long(float(np.max(seconds)))})"


def _finding(record: Record, same: Sequence[Verdict]) -> dict[str, str]:
    """What a test found; quantities that it found in the same readings are listed at once."""
    first = same[0]
    return {
        "test": f"{first.test[0].upper()}{first.test[1:]}",
        "flag": _WORDS[first.flag],
        "count": f"{len(first.rows):,}",
        "quantities": ", ".join(one.key for one in same),
        "times": _times(record, first),
        "why": first.example.split(": ", 1)[-1].rsplit(" Flagged ", 1)[0],
    }


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
