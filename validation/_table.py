"""The table as Markdown to read and as JSON or CSV to go on with."""

import csv
import io
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict

from validation._row import Row, Section, Span, ends

Table = Mapping[str, tuple[Section, Sequence[Row]]]
"""Sections and their rows, by title."""

HEAD = """# Validation

**No measured load of a known cage is on this page.** No test that prints a cage's geometry,
weights, nets, water and forces was in reach: what is measured here are panels of netting, a
cylinder, volumes, lifts, and bounds for cages whose gear is not printed. A measured cage joins by
one TOML and one CSV: [validation/README.md](../validation/README.md) has an example with waves,
a mooring and line tensions, and says how a row is added. `make validate` computes this page.

- *kind* says what stands behind a reference: **measured**, a **closed form**, a **published
  model**, an **other program**, an **in-house model** (a simpler prototype of this project, so no
  independent proof), or **our own** answer to a question that must not change it (half the time
  step, a mirrored sea).
- A row *holds* when ours differs from the reference by no more than the tolerance. An interval in
  *ours* is what an ensemble of plausible cages and laws spans, because the source does not print
  the cage: it must contain the reference.
- Rows marked **(may miss)** are numbers whose conditions are not printed whole, and two weak points
  that are known. A miss is shown, with the reason, and fails nothing. All others must hold.
- Where seas, lines or meshes are compared, the worst counts and not their mean.
"""
COLUMNS = ("quantity", "reference", "kind, source", "ours", "tolerance", "holds")


def markdown(table: Table) -> str:
    """The page for the docs."""
    parts = [HEAD, _summary(table), _misses(table)]
    return "\n".join([*parts, *(_section(section, rows) for section, rows in table.values())])


def _summary(table: Table) -> str:
    lines = [_line(("section", "rows", "hold", "missed", "not computed")), _line(["---"] * 5)]
    counts = [_counts(rows) for _, rows in table.values()]
    for title, count in zip(table, counts, strict=True):
        lines.append(_line((f"[{title}](#{_anchor(title)})", *map(str, count))))
    whole = [sum(column) for column in zip(*counts, strict=True)]
    return "\n".join([*lines, _line(("**all**", *map(str, whole))), ""])


def _counts(rows: Sequence[Row]) -> list[int]:
    verdicts = [row.verdict for row in rows]
    return [len(rows), *(verdicts.count(verdict) for verdict in ("yes", "no", "–"))]


def _anchor(title: str) -> str:
    """As Markdown makes it: lower case, hyphens for spaces, no commas."""
    return "".join(c for c in title.lower().replace(" ", "-") if c.isalnum() or c == "-")


def _misses(table: Table) -> str:
    """Why numbers are missed, each reason once, with the rows it stands for."""
    reasons: dict[str, list[Row]] = {}
    for row in (row for _, rows in table.values() for row in rows if row.verdict == "no"):
        reasons.setdefault(row.note, []).append(row)
    if not reasons:
        return ""
    lines = ["## What we miss", ""]
    for note, rows in reasons.items():
        several = f"{rows[0].what}, and {len(rows) - 1} more" if len(rows) > 1 else rows[0].what
        lines.append(f"- *{several}.* {note or 'It must hold: mend it.'}")
    return "\n".join([*lines, ""])


def _section(section: Section, rows: Sequence[Row]) -> str:
    notes = list(dict.fromkeys(row.note for row in rows if row.note))
    lines = [f"## {section.title}", "", section.about, ""]
    lines += [_line(COLUMNS), _line(["---"] * len(COLUMNS))]
    lines += [_line(_cells(row, notes)) for row in rows]
    numbered = [f"{number}. {note}" for number, note in enumerate(notes, 1)]
    return "\n".join([*lines, "", *numbered, ""] if notes else [*lines, ""])


def _cells(row: Row, notes: Sequence[str]) -> list[str]:
    unit = "" if row.unit == "-" else f" {row.unit}"
    ours = "–" if row.ours is None else f"{shown(row.ours)}{unit}"
    verdict = f"**{row.verdict}**" if row.verdict == "no" else row.verdict
    verdict = verdict if row.must_hold else f"{verdict} (may miss)"
    return [
        row.what,
        f"{shown(row.reference)}{unit}",
        f"{row.kind}; {row.source}",
        f"{ours} ({row.detail})" if row.detail else ours,
        f"± {_number(row.tolerance, digits=2)}{unit}: {row.reason}",
        f"{verdict}, note {notes.index(row.note) + 1}" if row.note else verdict,
    ]


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def shown(span: Span, *, digits: int = 4) -> str:
    """A number to so many digits, or an interval."""
    low, high = ends(span)
    if low == high:
        return _number(low, digits=digits)
    if math.isinf(low):
        return f"≤ {_number(high, digits=digits)}"
    if math.isinf(high):
        return f"≥ {_number(low, digits=digits)}"
    return f"{_number(low, digits=digits)} to {_number(high, digits=digits)}"


def _number(value: float, *, digits: int = 4) -> str:
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text.replace("-", "−")
    mantissa, exponent = text.split("e")
    if int(exponent) >= 0:
        return f"{value:.0f}".replace("-", "−")
    return f"{mantissa}·10^{int(exponent)}".replace("-", "−")


def as_json(table: Table) -> str:
    """All rows with their numbers unrounded; JSON has no infinity, so an open end is null."""
    return json.dumps(
        {title: [_record(row) for row in rows] for title, (_, rows) in table.items()},
        ensure_ascii=False,
        indent=1,
    )


def as_csv(table: Table) -> str:
    """All rows, one a line."""
    records = [
        {"section": title, **_flat(row)} for title, (_, rows) in table.items() for row in rows
    ]
    text = io.StringIO()
    writer = csv.DictWriter(text, fieldnames=list(records[0]) if records else ["section"])
    writer.writeheader()
    writer.writerows(records)
    return text.getvalue()


def _record(row: Row) -> dict[str, object]:
    spans = {name: _ends_or_none(getattr(row, name)) for name in ("reference", "ours")}
    return {**asdict(row), **spans, "holds": row.verdict}


def _flat(row: Row) -> dict[str, object]:
    record = _record(row)
    for name in ("reference", "ours"):
        low, high = record.pop(name) or (None, None)  # pyright: ignore[reportGeneralTypeIssues]
        record |= {f"{name}_low": low, f"{name}_high": high}
    return record


def _ends_or_none(span: Span | None) -> tuple[float | None, float | None] | None:
    if span is None:
        return None
    low, high = (value if math.isfinite(value) else None for value in ends(span))
    return low, high
