"""The wizard: what a foreign file seems to be, and a map of it to edit, with nothing guessed."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import json
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from seacage.conventions import RecordError
from seacage.records._readers._cf import (
    STANDARD_NAMES,
    is_compass,
    is_netcdf,
    open_foreign,
    vertical_of,
    zone_conflict,
)
from seacage.records._readers._column_map import parse_time, shipped_maps
from seacage.records._readers._csv import number_in, recognise
from seacage.records._readers._ndbc import is_ndbc
from seacage.records._readers._own_readers import read_by_own
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

if TYPE_CHECKING:
    import xarray

_NO_MAP = "It needs no map: import it as it is."
_ROWS = 20_000  # as many rows are looked at
_DATES = ("%d.%m.%Y", "%d.%m.%y", "%d/%m/%Y", "%m/%d/%Y", "%Y/%m/%d", "%d-%m-%Y")
_CLOCKS = ("%H:%M:%S", "%H:%M", "%H:%M:%S.%f", "%H.%M", "%I:%M:%S %p", "%I:%M %p")
_FORMATS = ("iso", *(f"{date} {clock}" for date in _DATES for clock in _CLOCKS), "%Y%m%d%H%M")
_DATE = r"\d{1,4}([-./])\d{1,2}\1\d{1,4}"  # a cell that holds no more than a date
_MARK = r"\d[-/.:T ]\d"  # between the parts of a time: numbers pass for ISO dates (20180126)
_SENTINELS = (99.0, 99.9, 99.99, 999.0, 999.9, 9999.0, -9.0, -99.0, -999.0, -9999.0, -32768.0)
_NAMES: tuple[tuple[str, str], ...] = (
    (r"(wave|peak|mean).*dir|^(mwd|thq|dirm|dirp|mdir|wdirw)$", "wave_direction"),
    (r"^(wvht|hs|hm0|swh|vhm0|hsig)$|sig.*height|wave.*height", "hs"),
    (r"^(dpd|tp|vtpk)$|peak.*period", "tp"),
    (r"wind|gust|^w(spd|dir|10)$|^d10$|sound", ""),
    (r"(^|_|\b)(u|east|ve|vel_?e|u_?vel)(\b|_|$)|eastward", "current_east"),
    (r"(^|_|\b)(v|north|vn|vel_?n|v_?vel)(\b|_|$)|northward", "current_north"),
    (
        r"curr.*dir|^dir(ection)?(#?\d*)$|^dir(ection)?_(to|from|towards)|retn|^set$",
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
# A current is declared in one of two ways
_WAYS = (("current_speed", "current_direction"), ("current_east", "current_north"))
_MAGNETIC = r"mag|deg\.?\s?m\b|°\s?m\b"
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
        with open_foreign(path) as dataset:
            return _inspect_netcdf(path, dataset)
    if own := read_by_own(path, "buoy-1"):
        finding = f"{path.name} has {len(own)} rows of {', '.join(own.values)}."
        return Inspection(findings=(finding, *own.notes, _NO_MAP), map_text="")
    if path.suffix.lower() in {".parquet", ".json"}:
        layout, table = PLAIN, read_table(path, PLAIN)
    else:
        layout, text = _layout(path)
        if is_ndbc(text):
            finding = "is a file of NDBC, whose names, units, senses and zone are documented."
            return Inspection(findings=(f"{path.name} {finding}", _NO_MAP), map_text="")
        table = text_table(path, text, layout)
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
    decimal = "," if comma else "."
    named = not lines or _are_names(_split(lines[first], delimiter), decimal)
    return Layout(encoding, delimiter, decimal, skip, named), text


def _are_names(cells: Sequence[str], decimal: str) -> bool:
    """Whether a table's first cells are a header: there is no date, and not numbers alone."""
    texts = [cell.strip('" ') for cell in cells]
    dated = any(re.match(_DATE, text) for text in texts)
    return not dated and any(number_in(text, decimal) is None for text in texts)


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
        fits = f"It fits a known map and needs none: {recognise(table).title}."
    except RecordError:
        fits = "No shipped map fits its columns."
    if not layout.header:
        fits = "It has no header, so its columns are named by number, from 1."
        known = (name for name, one in shipped_maps().items() if not one.names ^ {*table.header})
        fits += "".join(f" The shipped map {name} has as many." for name in known)
    findings.append(fits)
    time_names, time_lines, time_findings = _time(table, layout)
    findings += time_findings
    if table.cut:
        findings.append("Suspicious: it ends without a line end; the last row may be cut.")
    guesses: list[_Guess] = []
    for name in table.header:
        if name not in time_names:
            seen = {one.quantity for one in guesses if _place(one.name) == _place(name)}
            guesses.append(_guess(table, name, layout, seen))
    findings += [one.finding for one in guesses]
    return Inspection(findings=tuple(findings), map_text=_toml(table, layout, time_lines, guesses))


def _time(table: Table, layout: Layout) -> tuple[tuple[str, ...], list[str], list[str]]:
    """The time's columns, their lines in the map, and what was found."""
    best = _time_columns(table)
    if best is None:
        finding = "No column reads as a time; name it, or the several that make it, under [time]."
        return (), ['column = "?"', 'format = "?"', 'zone = "?"'], [finding]
    names, cells, formats = best
    stated = parse_time(cells[0], formats[0]).tzinfo is not None
    zone = 'zone = "?"  # "UTC", "+01:00"; "Europe/Oslo" if its clock follows daylight saving'
    spelled = "not said"
    if stated:
        zone, spelled = 'zone = "stated"  # each time says it', "stated in each"
    elif re.search(r"\b(utc|gmt)\b", " ".join(names).lower()):
        zone, spelled = 'zone = "UTC"  # for its name', "UTC, for its name"
    form = f"format = {_quote(formats[0])}"
    spoken = " with ".join(repr(name) for name in names)
    form_text = " or ".join(formats)
    findings = [f"{spoken} is the time, in the format {form_text}; its zone is {spelled}."]
    if len(formats) > 1:
        form = f'format = "?"  # {form_text}: the days do not tell'
        findings.append("Suspicious: day and month cannot be told apart in it.")
    column = ", ".join(_key(name, layout) for name in names)
    lines = [f"column = {column if len(names) == 1 else f'[{column}]'}", form, zone]
    return names, lines, findings + _cadence(cells, formats[0])


def _time_columns(table: Table) -> tuple[tuple[str, ...], list[str], list[str]] | None:
    """The date's and the clock's columns, or the first whose every cell is a time.

    With their texts, joined, and the formats that fit them all.
    """
    pairs = [
        (date, clock)
        for date, clock in pairwise(table.header)
        if re.fullmatch(_DATE, table.column(date)[0].strip())
        and (":" in table.column(clock)[0] or re.match(r"kl|tid|time|clock", clock.lower()))
    ]
    for names in (*pairs, *((name,) for name in table.header)):
        columns = [table.column(name)[:_ROWS] for name in names]
        cells = [" ".join(parts) for parts in zip(*columns, strict=True)]
        if re.search(_MARK, cells[0]) and any(number_in(cell, ".") is None for cell in cells):
            formats = [form for form in _FORMATS if all(_fits(cell, form) for cell in cells)]
            if formats:
                return names, cells, formats
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


def _guess(table: Table, name: str, layout: Layout, seen: set[str]) -> _Guess:
    """What a column seems to be, beside the quantities of the same place that were seen."""
    cells = table.column(name)[:_ROWS]
    numbers = [number_in(cell, layout.decimal) for cell in cells]
    known = np.array([n for n in numbers if n is not None and np.isfinite(n)])
    quantity = _quantity(name) if known.size else ""
    if known.size and known.min() < known.max() and not layout.header:
        quantity = "?"
    other = next((two for one, two in (_WAYS, _WAYS[::-1]) if quantity in one), ())
    if quantity not in {"", "?"} and seen & {quantity, *other}:
        finding = f"{name!r} looks like {quantity} too, and one is read; it is under ignored."
        return _Guess(name, "", (), finding)
    if not quantity:
        return _Guess(name, "", (), f"{name!r} is no quantity that is read; it is under ignored.")
    span = f"{known.min():g} to {known.max():g}"
    why = "or list the column as ignored" if quantity == "?" else "for its name"
    lines = [f"quantity = {_quote(quantity)}  # {why}; {span} in the file"]
    lines.append(_unit_line(name, quantity, known))
    if quantity.endswith("direction"):
        lines.append(_sense_line(name, quantity))
    if quantity.endswith(("direction", "east", "north")) and re.search(_MAGNETIC, name.lower()):
        lines.append('north = "magnetic"  # for its name')
        lines.append('declination_deg = "?"  # of the place and year, positive to the east')
    if (place := _place(name)) and not quantity.startswith(("tension", "depth")):
        lines.append(f"{place[0]} = {place[1]:g}  # for its name")
    odd = _oddities(numbers, known)
    held = [value for value in _SENTINELS if np.sum(known == value) > 1]
    if held:
        lines.append(f"# missing = {held}  # if these stand for no value")
    open_ = ", ".join(line.split(" =")[0] for line in lines if '"?"' in line)
    missing = f"; fill in its {open_}" if open_ else ""
    seems = "" if quantity == "?" else f" looks like {quantity},"
    return _Guess(name, quantity, tuple(lines), f"{name!r}{seems or ' is'} {span}{missing}.{odd}")


def _quantity(name: str) -> str:
    text = re.sub(r"[\[(].*", "", name).strip().lower()
    text = re.sub(r"_?(cm_s|mm_s|m_s|deg|kn|_m|_s)$", "", text)
    for pattern, quantity in _NAMES:
        if re.search(pattern, text):
            return quantity
    return ""


def _unit_line(name: str, quantity: str, known: np.ndarray) -> str:
    for pattern, unit in _SPELLED:
        if re.search(pattern, name.lower()) and unit in _UNITS_OF.get(quantity, ()):
            return f"unit = {_quote(unit)}  # for its name"
    hint = " or ".join(_UNITS_OF.get(quantity, ("of the file's numbers",)))
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


def _place(name: str) -> tuple[str, float] | None:
    """Where in a profile a column is, by its name: Dir#1(5.4m) has the number of its cell first.

    Such a name has the distance from the instrument, others the depth.
    """
    if match := re.search(r"#\d+ ?\((\d+(?:\.\d+)?) ?m\)", name):
        return "range_m", float(match[1])
    match = re.search(r"(?:^|_|\b)(\d+(?:\.\d+)?)_?m(?:_|\b|$)(?!_s)", name)
    return ("depth_m", float(match[1])) if match else None


def _toml(
    table: Table, layout: Layout, time_lines: Sequence[str], guesses: Sequence[_Guess]
) -> str:
    ignored = ", ".join(_key(one.name, layout) for one in guesses if not one.quantity)
    places = {place for one in guesses if one.quantity and (place := _place(one.name))}
    file = "".join(letter if letter.isprintable() else "?" for letter in table.path.name)
    lines = [
        f"# Begun by `seacage field import --inspect` from {file}. Fill in",
        '# every "?"; importing refuses the map until then. Comments say where a guess is from.',
        f"title = {_quote(table.path.stem)}",
        'origin = "?"  # "measured" or "computed"',
        f"ignored = [{ignored}]",
    ]
    for kind in sorted({kind for kind, _ in places}):
        found = ", ".join(f"{place:g}" for one, place in sorted(places) if one == kind)
        lines.append(f'{kind} = "?"  # which to read: {found}')
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
    lines += ["header = false"] * (not layout.header)
    lines += ["", "[time]", *time_lines]
    for one in guesses:
        if one.quantity:
            lines += ["", f"[columns.{_key(one.name, layout)}]", *one.lines]
    return "\n".join(lines) + "\n"


def _key(name: str, layout: Layout) -> str:
    """A column as a map names it: by its name, or by number where there is no header."""
    return _quote(name) if layout.header else name


def _quote(text: str) -> str:
    """A TOML string; JSON's escapes are TOML's, but for the DEL that JSON leaves."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")


def _inspect_netcdf(path: Path, dataset: "xarray.Dataset") -> Inspection:
    """Look at a NetCDF file's variables and begin its map."""
    sizes = ", ".join(f"{name} {size}" for name, size in dataset.sizes.items())
    findings = [f"{path.name} is a NetCDF file with the dimensions {sizes}."]
    lines = [
        'kind = "netcdf"',
        f"title = {_quote(path.stem)}",
        'origin = "?"  # "measured" or "computed"',
    ]
    if conflict := zone_conflict(dataset):
        findings.append(f"Suspicious: {conflict.reason}.")
        lines.append(f'time_zone = "?"  # {conflict.choices}')
    read = [name for name in map(str, dataset.data_vars) if _tells(dataset, name)]
    findings += [_sentence(dataset, name) for name in map(str, dataset.data_vars)]
    dims = {str(dim) for name in read for dim in dataset[name].dims}
    at: list[str] = []
    for dim in sorted(dims):
        size = dataset.sizes[dim]
        if size == 1 or dim == "time" or is_compass(dataset, dim):
            continue
        if kind := vertical_of(dataset, dim):
            places = np.asarray(dataset[dim].values, dtype=np.float64)
            lines.append(f'{kind}_m = "?"  # one of {", ".join(f"{p:g}" for p in places)}')
        else:
            at.append(f'{dim} = "?"  # an index, 0 to {size - 1}')
    if at:
        lines += ["", "[at]", *at]
    if not read:
        findings.append("No standard name tells what to read; declare variables in the map.")
        lines += [
            "",
            '[columns."?"]  # a variable of the file',
            'quantity = "?"  # current_east, current_north, hs, …',
            'unit = "?"',
        ]
    return Inspection(findings=tuple(findings), map_text="\n".join(lines) + "\n")


def _tells(dataset: "xarray.Dataset", name: str) -> bool:
    array = dataset[name]
    velocity = str(array.attrs.get("units", "")).startswith(("m s", "m/s", "cm s", "cm/s"))
    split = any(is_compass(dataset, dim) for dim in array.dims)
    return array.attrs.get("standard_name") in STANDARD_NAMES or (velocity and split)


def _sentence(dataset: "xarray.Dataset", name: str) -> str:
    attributes = dataset[name].attrs
    meaning = attributes.get("standard_name") or attributes.get("long_name") or "no name"
    units = attributes.get("units", "no units")
    verdict = "is read" if _tells(dataset, name) else "is not read"
    return f"{name!r} ({meaning}, {units}) {verdict}."
