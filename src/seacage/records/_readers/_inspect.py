"""The wizard: what a foreign file seems to be, and a map of it to edit, with nothing guessed."""

import json
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC
from pathlib import Path
from typing import NamedTuple

import numpy as np

from seacage.conventions import RecordError
from seacage.records._readers._cf import is_netcdf
from seacage.records._readers._column_map import parse_time
from seacage.records._readers._csv import number_in, recognise
from seacage.records._readers._inspect_netcdf import inspect_netcdf
from seacage.records._readers._ndbc import is_ndbc
from seacage.records._readers._table import (
    PLAIN,
    WHITESPACE,
    Layout,
    Table,
    read_table,
    read_text,
    text_table,
)
from seacage.records._times import microseconds

_ROWS = 20_000  # as many rows are looked at
_FORMATS = (
    "iso",
    "%d.%m.%Y %H:%M:%S",
    "%d.%m.%Y %H:%M",
    "%d/%m/%Y %H:%M:%S",
    "%d/%m/%Y %H:%M",
    "%m/%d/%Y %H:%M:%S",
    "%m/%d/%Y %H:%M",
    "%Y/%m/%d %H:%M:%S",
    "%Y/%m/%d %H:%M",
    "%Y%m%d%H%M",
)
_SENTINELS = (99.0, 99.9, 99.99, 999.0, 999.9, 9999.0, -9.0, -99.0, -999.0, -9999.0, -32768.0)
_NAMES: tuple[tuple[str, str], ...] = (
    (r"(wave|peak|mean).*dir|^(mwd|thq|dirm|dirp|mdir|wdirw)$", "wave_direction"),
    (r"^(wvht|hs|hm0|swh|vhm0|hsig)$|sig.*height|wave.*height", "hs"),
    (r"^(dpd|tp|vtpk)$|peak.*period", "tp"),
    (r"wind|gust|^w(spd|dir|10)$|^d10$", ""),
    (r"(^|_|\b)(u|east|ve|vel_?e|u_?vel)(\b|_|$)|eastward", "current_east"),
    (r"(^|_|\b)(v|north|vn|vel_?n|v_?vel)(\b|_|$)|northward", "current_north"),
    (
        r"curr.*dir|^dir(ection)?\d*$|^dir(ection)?_(to|from|towards)|retn|^set$",
        "current_direction",
    ),
    (r"speed|spd|veloc|fart|strøm", "current_speed"),
    (r"tension|load|shackle|force|kraft|last", "tension"),
    (r"depth|dyp", "depth"),
)
_SPELLED: tuple[tuple[str, str], ...] = (
    (r"cm[/_ ]?s(ec)?(\b|_|$|-1)", "cm/s"),
    (r"mm[/_ ]?s(ec)?(\b|_|$|-1)", "mm/s"),
    (r"km[/_ ]?h", "km/h"),
    (r"(^|[^a-z])m[/_ ]?s(ec)?(\b|_|$|-1)", "m/s"),
    (r"knot|(^|[^a-z])kt?n?s?\)?$", "knot"),
    (r"deg|°", "deg"),
    (r"(^|[^a-z])kn(\b|_|$)", "kN"),
    (r"(^|[^a-z])tf(\b|_|$)", "tf"),
    (r"[_\[( ]cm[\])]?$", "cm"),
    (r"[_\[( ]m[\])]?$", "m"),
    (r"[_\[( ]s(ec)?[\])]?$", "s"),
)
_UNITS_OF: Mapping[str, tuple[str, ...]] = {
    **dict.fromkeys(
        ("current_speed", "current_east", "current_north"), ("m/s", "cm/s", "mm/s", "km/h", "knot")
    ),
    **dict.fromkeys(("current_direction", "wave_direction"), ("deg",)),
    **dict.fromkeys(("hs", "depth"), ("m", "cm")),
    "tp": ("s",),
    "tension": ("kN", "tf"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Inspection:
    """What a file seems to be."""

    findings: tuple[str, ...]  # one sentence each
    map_text: str  # the map to edit, in TOML; a value that only the user knows is ``"?"``

    @property
    def open_questions(self) -> int:
        """How many values only the user can fill in."""
        return len(re.findall(r'= "\?"', self.map_text))


class _Guess(NamedTuple):
    """What a column seems to be; an empty quantity goes under ignored."""

    name: str
    quantity: str
    lines: tuple[str, ...]  # of its table in the map
    finding: str


def inspect_file(path: Path | str) -> Inspection:
    """Look at a foreign file and begin its map.

    Units, senses and zones are taken from what the file says: a name, a suffix, an offset. What
    it does not say stays ``"?"`` with a hint beside it, and importing refuses such a map.

    ``path``: a table of text or Parquet, or NetCDF.

    Raises RecordError: a file that cannot be read as any of them.
    """
    path = Path(path)
    if not path.is_file():
        raise RecordError(f"{path}: there is no such file.")
    if is_netcdf(path):
        findings, map_text = inspect_netcdf(path)
        return Inspection(findings=findings, map_text=map_text)
    if path.suffix.lower() in {".parquet", ".json"}:
        layout, table = PLAIN, read_table(path, PLAIN)
    else:
        layout, text = _layout(path)
        if is_ndbc(text):
            finding = "is a file of NDBC, whose names, units, senses and zone are documented."
            advice = "It needs no map: import it as it is."
            return Inspection(findings=(f"{path.name} {finding}", advice), map_text="")
        table = text_table(path, text, delimiter=layout.delimiter, skip_lines=layout.skip_lines)
    return _inspect_table(table, layout)


def _layout(path: Path) -> tuple[Layout, str]:
    """How the text is written: the first encoding that fits, the delimiter that parts evenly."""
    with path.open("rb") as file:
        mark = file.read(2)
    marked = mark in {b"\xff\xfe", b"\xfe\xff"}
    encoding, text = _decode(path, ("utf-16",) if marked else ("utf-8", "cp1252", "latin-1"))
    lines = [line for line in text.splitlines()[:200] if line.strip()]
    counted = {d: _count(lines, d) for d in (";", "\t", ",", "|", WHITESPACE)}
    delimiter = next((one for one, count in counted.items() if count > 1), ",")
    width = counted[delimiter]
    first = next((at for at, line in enumerate(lines) if len(_split(line, delimiter)) == width), 0)
    cells = [cell for line in lines[first + 1 :] for cell in _split(line, delimiter)]
    comma = delimiter != "," and any(re.fullmatch(r"\s*-?\d+,\d+\s*", cell) for cell in cells)
    skip = text.splitlines().index(lines[first]) if lines else 0
    return Layout(encoding, delimiter, "," if comma else ".", skip), text


def _decode(path: Path, encodings: tuple[str, ...]) -> tuple[str, str]:
    """The first encoding that the bytes are text in, and the text."""
    for encoding in encodings[:-1]:
        with suppress(RecordError):
            return encoding, read_text(path, encoding)
    return encodings[-1], read_text(path, encodings[-1])


def _split(line: str, delimiter: str) -> list[str]:
    return line.split() if delimiter == WHITESPACE else line.split(delimiter)


def _count(lines: Sequence[str], delimiter: str) -> int:
    """Cells per line where most lines have as many, else 0."""
    widths = [len(_split(line, delimiter)) for line in lines]
    if not widths:
        return 0
    common = max(set(widths), key=widths.count)
    return common if widths.count(common) > 0.8 * len(widths) else 0


def _inspect_table(table: Table, layout: Layout) -> Inspection:
    findings = [
        f"{table.path.name} is a table of {len(table.rows)} rows and {len(table.header)} columns.",
        f"Its cells are parted by {layout.delimiter!r}, its decimals by {layout.decimal!r}.",
    ]
    try:
        findings.append(f"It fits a known map and needs none: {recognise(table).title}.")
    except RecordError:
        findings.append("No shipped map fits its columns.")
    time_names, time_lines, time_findings = _time(table)
    findings += time_findings
    if table.cut:
        findings.append("Suspicious: it ends without a line end; the last row may be cut.")
    guesses: list[_Guess] = []
    for name in table.header:
        if name not in time_names:
            seen = {(one.quantity, _depth(one.name)) for one in guesses}
            guesses.append(_guess(table, name, layout.decimal, seen))
    findings += [one.finding for one in guesses]
    return Inspection(findings=tuple(findings), map_text=_toml(table, layout, time_lines, guesses))


def _time(table: Table) -> tuple[tuple[str, ...], list[str], list[str]]:
    """The time's columns, their lines in the map, and what was found."""
    best = _time_column(table)
    if best is None:
        finding = "No column reads as a time; name it, or the several that make it, under [time]."
        return (), ['column = "?"', 'format = "?"', 'zone = "?"'], [finding]
    name, formats = best
    cells = table.column(name)[:_ROWS]
    stated = parse_time(cells[0], formats[0]).tzinfo is not None
    zone = 'zone = "stated"  # each time says it' if stated else 'zone = "?"  # "UTC", "+01:00"'
    form = f"format = {_quote(formats[0])}"
    stated_where = "stated in each" if stated else "not said"
    findings = [
        f"{name!r} is the time, in the format {' or '.join(formats)}; its zone is {stated_where}."
    ]
    if len(formats) > 1:
        form = f'format = "?"  # {" or ".join(formats)}: the days do not tell'
        findings.append("Suspicious: day and month cannot be told apart in it.")
    lines = [f"column = {_quote(name)}", form, zone]
    return (name,), lines, findings + _cadence(cells, formats[0])


def _time_column(table: Table) -> tuple[str, list[str]] | None:
    """Return the first column whose every cell is a time, with the formats that fit them all."""
    for name in table.header:
        cells = table.column(name)[:_ROWS]
        # Numbers pass for ISO dates (20180126), but a time has a mark between its parts.
        if not re.search(r"\d[-/.:T ]\d", cells[0]):
            continue
        formats = [form for form in _FORMATS if all(_fits(cell, form) for cell in cells)]
        if formats and not all(number_in(cell, ".") is not None for cell in cells):
            return name, formats
    return None


def _fits(cell: str, form: str) -> bool:
    try:
        parse_time(cell, form)
    except ValueError:
        return False
    return True


def _cadence(cells: Sequence[str], form: str) -> list[str]:
    parsed = (parse_time(cell, form) for cell in cells)
    times = np.array([microseconds(t if t.tzinfo else t.replace(tzinfo=UTC)) for t in parsed])
    if times.size < 3:
        return []
    late = int(np.sum(times < np.maximum.accumulate(times)))
    steps = np.diff(np.unique(times)) / 60e6
    findings: list[str] = []
    if steps.size:
        usual = float(np.median(steps))
        gaps = steps[steps > 3.0 * usual]
        findings.append(
            f"A row comes every {usual:.3g} min (median; {steps.min():.3g} to {steps.max():.3g}); "
            f"{gaps.size} gaps are longer than three times that."
        )
    if late:
        findings.append(f"Suspicious: {late} rows are out of order; importing sorts them.")
    if twice := times.size - np.unique(times).size:
        findings.append(
            f"Suspicious: {twice} rows repeat a time; importing keeps the first of each."
        )
    return findings


def _guess(table: Table, name: str, decimal: str, seen: set[tuple[str, float | None]]) -> _Guess:
    cells = table.column(name)[:_ROWS]
    numbers = [number_in(cell, decimal) for cell in cells]
    known = np.array([n for n in numbers if n is not None and np.isfinite(n)])
    quantity = _quantity(name) if known.size else ""
    if quantity and (quantity, _depth(name)) in seen:
        finding = f"{name!r} looks like {quantity} too, and one is read; it is under ignored."
        return _Guess(name, "", (), finding)
    if not quantity:
        return _Guess(name, "", (), f"{name!r} is no quantity that is read; it is under ignored.")
    span = f"{known.min():g} to {known.max():g}"
    lines = [f"quantity = {_quote(quantity)}  # for its name; {span} in the file"]
    lines.append(_unit_line(name, quantity, known))
    if quantity.endswith("direction"):
        lines.append(_sense_line(name, quantity))
    if (depth := _depth(name)) is not None and not quantity.startswith(("tension", "depth")):
        lines.append(f"depth_m = {depth:g}  # for its name")
    odd = _oddities(numbers, known)
    held = [value for value in _SENTINELS if np.sum(known == value) > 1]
    if held:
        lines.append(f"# missing = {held}  # if these stand for no value")
    open_ = ", ".join(line.split(" =")[0] for line in lines if '"?"' in line)
    missing = f"; fill in its {open_}" if open_ else ""
    finding = f"{name!r} looks like {quantity}, {span}{missing}.{odd}"
    return _Guess(name, quantity, tuple(lines), finding)


def _quantity(name: str) -> str:
    text = re.sub(r"[\[(].*", "", name).strip().lower()
    text = re.sub(r"_?(cm_s|mm_s|m_s|deg|kn|_m|_s)$", "", text)
    for pattern, quantity in _NAMES:
        if re.search(pattern, text):
            return quantity
    return ""


def _unit_line(name: str, quantity: str, known: np.ndarray) -> str:
    for pattern, unit in _SPELLED:
        if re.search(pattern, name.lower()) and unit in _UNITS_OF[quantity]:
            return f"unit = {_quote(unit)}  # for its name"
    hint = " or ".join(_UNITS_OF[quantity])
    if quantity == "current_speed":
        hint += "; a sea current is mostly below 2 m/s"
    return f'unit = "?"  # {hint}; the largest is {known.max():g}'


def _sense_line(name: str, quantity: str) -> str:
    words = name.lower()
    if re.search(r"(^|_|\b)(to|towards)(_|\b|$)", words):
        return 'sense = "towards"  # for its name'
    if re.search(r"(^|_|\b)from(_|\b|$)", words):
        return 'sense = "from"  # for its name'
    usual = "waves are mostly from" if quantity == "wave_direction" else "files differ"
    return f'sense = "?"  # "towards" or "from": {usual}; the file\'s paper tells'


def _oddities(numbers: Sequence[float | None], known: np.ndarray) -> str:
    strange = sum(n is None for n in numbers)
    odd = f" Suspicious: {strange} cells are no number." if strange else ""
    if known.size > 2 and known.min() == known.max():
        odd += " Suspicious: it never changes."
    return odd


def _depth(name: str) -> float | None:
    match = re.search(r"(?:^|_|\b)(\d+(?:\.\d+)?)_?m(?:_|\b|$)(?!_s)", name)
    return float(match[1]) if match else None


def _toml(
    table: Table, layout: Layout, time_lines: Sequence[str], guesses: Sequence[_Guess]
) -> str:
    ignored = ", ".join(_quote(one.name) for one in guesses if not one.quantity)
    depths = sorted({d for one in guesses if one.quantity and (d := _depth(one.name)) is not None})
    file = "".join(letter if letter.isprintable() else "?" for letter in table.path.name)
    lines = [
        f"# Begun by `seacage field import --inspect` from {file}. Fill in",
        '# every "?"; importing refuses the map until then. Comments say where a guess is from.',
        f"title = {_quote(table.path.stem)}",
        'origin = "?"  # "measured" or "computed"',
        f"ignored = [{ignored}]",
    ]
    if depths:
        lines.append(f'depth_m = "?"  # which to read: {", ".join(f"{d:g}" for d in depths)}')
    lines += [
        f"{name} = {_quote(value)}"
        for name, value, usual in (
            ("delimiter", layout.delimiter, ","),
            ("decimal", layout.decimal, "."),
            ("encoding", layout.encoding, "utf-8"),
        )
        if value != usual
    ]
    if layout.skip_lines:
        lines.append(f"skip_lines = {layout.skip_lines}")
    lines += ["", "[time]", *time_lines]
    for one in guesses:
        if one.quantity:
            lines += ["", f"[columns.{_quote(one.name)}]", *one.lines]
    return "\n".join(lines) + "\n"


def _quote(text: str) -> str:
    """A TOML string; JSON's escapes are TOML's, but for the DEL that JSON leaves."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")
