"""A case that a user adds: one TOML on what was measured, one CSV with the numbers."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from difflib import get_close_matches
from itertools import product
from pathlib import Path
from typing import Any, get_args

from seacage.cage import Cage, Structure
from seacage.conventions import InputError, parse_toml, read_text
from seacage.dynamics import LAWS, MOVING_LAWS, Mooring
from seacage.ocean import SeaState
from validation._answers import How, Water
from validation._panel import Panel, panel_of
from validation._quantities import Conditions, Quantity, Subject, quantity_named
from validation._row import Kind

CASES = Path(__file__).parent / "cases"
KEYS: dict[str, type | tuple[type, ...]] = {
    **dict.fromkeys(("title", "about", "kind", "source", "cage", "structure"), str),
    **dict.fromkeys(("collar", "mooring"), str),
    **dict.fromkeys(("laws", "twine_drag"), list),
    **dict.fromkeys(("pipe_drag", "wake", "present_area", "must_hold"), bool),
    **dict.fromkeys(("spin_up_s", "duration_s", "time_step_s"), (int, float)),
    "note": str,
    **dict.fromkeys(("panel", "changes", "ensemble", "tolerance"), dict),
}
NEEDED = ("title", "kind", "source", "tolerance")
SUBJECTS = ("cage", "structure", "panel")
OF_A_CAGE = ("current_to_deg", "hs_m", "tp_s", "wave_height_m", "wave_period_s", "wave_from_deg")
OF_A_PANEL = ("angle_deg", "solidity")
UNCERTAINTY = "uncertainty:"
STATISTICS_OF_WAVES = 1800.0
"""That are simulated of irregular waves where a case does not say [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """A share of the measured value, a fixed part in the quantity's unit, and why.

    ``last_digits`` counts units of the last digit that the CSV prints: 0.5 of 18.9 is 0.05.
    """

    share: float
    fixed: float
    last_digits: float
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """One number of the CSV, its last digit's unit, and the conditions it was measured in."""

    at: Conditions
    law: str | None  # None: the case's
    quantity: Quantity
    value: float
    digit: float
    uncertainty: float
    may_miss: bool
    note: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A case as its two files describe it.

    Attributes
    ----------
    subjects
        All that the ensemble spans; one where the cage is known.
    """

    name: str
    title: str
    about: str
    kind: Kind
    source: str
    subjects: Sequence[Subject]
    laws: Sequence[str]
    how: How
    must_hold: bool
    note: str
    tolerance: Mapping[str, Tolerance]
    measured: Sequence[Measured]


def read_cases(folder: Path = CASES) -> list[Case]:
    """All cases of a folder, by name.

    Raises
    ------
    InputError
        A file that is missing or wrong: which, where, why and what to do.
    """
    return [read_case(path.parent) for path in sorted(folder.glob("*/case.toml"))]


def read_case(folder: Path) -> Case:
    """The case of one folder with ``case.toml`` and ``measured.csv``."""
    where = f"{folder.name}/case.toml"
    table = _table(folder / "case.toml", where)
    subject = _subject(folder, table, where)
    tolerance = {key: _tolerance(key, entry, where) for key, entry in table["tolerance"].items()}
    mooring = _mooring(table, subject, where)
    measured = list(_measured(folder, subject, mooring))
    for number in measured:
        if number.quantity.name not in tolerance:
            raise InputError(
                f'{where}: measured.csv has {number.quantity.name}, but [tolerance."'
                f'{number.quantity.name}"] is missing. Add it, with share, fixed, last_digits or '
                "several, and reason."
            )
    usual = MOVING_LAWS if isinstance(subject, Panel) else LAWS
    return Case(
        name=folder.name,
        title=table["title"],
        about=table.get("about", ""),
        kind=Kind(_one_of(table["kind"], [kind.value for kind in Kind], f"{where}: kind")),
        source=table["source"],
        subjects=list(_ensemble(subject, table.get("ensemble", {}), where)),
        laws=[_law(law, f"{where}: laws") for law in table.get("laws", usual)],
        how=_how(
            table,
            where,
            mooring=mooring,
            irregular=any(number.at.water.sea.hs > 0.0 for number in measured),
        ),
        must_hold=table.get("must_hold", False),
        note=table.get("note", ""),
        tolerance=tolerance,
        measured=measured,
    )


def _table(path: Path, where: str) -> dict[str, Any]:
    table = parse_toml(read_text(path), where)
    for key in NEEDED:
        if key not in table:
            raise InputError(f"{where}: the key {key!r} is missing. Add it.")
    for key, value in table.items():
        _one_of(key, list(KEYS), f"{where}: key")
        kind = KEYS[key]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            name = "number" if isinstance(kind, tuple) else kind.__name__
            raise InputError(f"{where}: {key} must be a {name}, not {value!r}. Mend it.")
    return table


def _one_of(value: Any, known: Sequence[str], where: str) -> str:
    if value not in known:
        close = get_close_matches(str(value), known, n=1)
        hint = f"did you mean {close[0]!r}?" if close else f"known are: {', '.join(known)}."
        raise InputError(f"{where} {value!r} is unknown; {hint}")
    return value


def _law(name: str, where: str) -> str:
    return _one_of(name, MOVING_LAWS, where)


def _subject(folder: Path, table: Mapping[str, Any], where: str) -> Subject:
    """A cage that comes with seacage or lies beside the case, a structure, or a panel."""
    named = [key for key in SUBJECTS if key in table]
    if len(named) != 1:
        raise InputError(
            f"{where}: it must have one of cage, structure and [panel], not {len(named)}. Say "
            "what was measured."
        )
    if named[0] == "panel":
        return panel_of(table["panel"], where)
    file = table[named[0]]
    if named[0] == "cage" and not file.endswith(".toml"):
        return Cage.named(file).altered(**table.get("changes", {}))
    if not (folder / file).is_file():
        raise InputError(f"{where}: there is no {named[0]} file {file} beside it. Put it there.")
    if named[0] == "structure":
        return Structure.read(folder / file)
    return Cage.read(folder / file).altered(**table.get("changes", {}))


def _ensemble(subject: Subject, choices: Mapping[str, Any], where: str) -> Iterator[Subject]:
    """Each combination of the choices, as a changed cage."""
    if not choices:
        yield subject
        return
    if not isinstance(subject, Cage):
        raise InputError(f"{where}: only a cage has an [ensemble]. Leave it out.")
    for key, values in choices.items():
        if key.count(".") != 1 or not isinstance(values, list) or not values:
            raise InputError(
                f"{where}: ensemble key {key!r} must name a section and a key of the cage file "
                'with the values it may have: "sinker_tube.weight_n_m" = [300.0, 570.0].'
            )
    for combination in product(*choices.values()):
        changes: dict[str, dict[str, Any]] = {}
        for key, value in zip(choices, combination, strict=True):
            section, parameter = key.split(".")
            changes.setdefault(section, {})[parameter] = value
        yield subject.altered(**changes)


def _mooring(table: Mapping[str, Any], subject: Subject, where: str) -> Mooring:
    """As it is built; a cage whose collar is held needs no anchors."""
    held = isinstance(subject, Cage) and table.get("collar") == "held"
    given = table.get("mooring", "springs" if held else "catenary")
    if "mooring" in table and not isinstance(subject, Cage):
        raise InputError(f"{where}: only a cage has a mooring of two kinds. Leave mooring out.")
    return _one_of(given, get_args(Mooring), f"{where}: mooring")  # pyright: ignore[reportReturnType]


def _how(table: Mapping[str, Any], where: str, *, mooring: Mooring, irregular: bool) -> How:
    twine = table.get("twine_drag")
    if twine is not None and not (len(twine) == 2 and all(isinstance(c, float) for c in twine)):
        raise InputError(
            f"{where}: twine_drag = {twine!r} must be two numbers, across and along a twine: "
            "[1.2, 0.08]."
        )
    collar = _one_of(table.get("collar", "moored"), ["held", "moored"], f"{where}: collar")
    return How(
        mooring=mooring,
        hold_collar=collar == "held",
        pipe_drag=table.get("pipe_drag", True),
        wake=table.get("wake", True),
        present_area=table.get("present_area", False),
        twine_drag=(twine[0], twine[1]) if twine else None,
        spin_up=float(table.get("spin_up_s", 300.0)),
        duration=float(table.get("duration_s", STATISTICS_OF_WAVES if irregular else 60.0)),
        time_step=float(table.get("time_step_s", 0.002)),
    )


def _tolerance(key: str, entry: Any, where: str) -> Tolerance:
    where = f'{where}: [tolerance."{key}"]'
    if not isinstance(entry, dict) or not isinstance(entry.get("reason"), str):
        raise InputError(f'{where}: the key reason is missing. Say why: reason = "…".')
    for name, value in entry.items():
        _one_of(name, ["share", "fixed", "last_digits", "reason"], f"{where}: key")
        if name != "reason" and not (isinstance(value, int | float) and value >= 0.0):
            raise InputError(f"{where}: {name} = {value!r} must be a number of at least 0.")
    parts = {name: float(entry.get(name, 0.0)) for name in ("share", "fixed", "last_digits")}
    return Tolerance(**parts, reason=entry["reason"])


def _measured(folder: Path, subject: Subject, mooring: Mooring) -> Iterator[Measured]:
    path, where = folder / "measured.csv", f"{folder.name}/measured.csv"
    if not path.is_file():
        raise InputError(f"{folder.name}: measured.csv is missing beside case.toml. Add it.")
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        names = list(reader.fieldnames or ())
        if "current_speed_m_s" not in names:
            raise InputError(
                f"{where}: the column current_speed_m_s is missing. Add it: each line is one "
                "current."
            )
        quantities = _quantities(names, subject, mooring, where)
        several = [
            number
            for line in reader
            for number in _numbers(line, quantities, f"{where}, line {reader.line_num}")
        ]
    if not several:
        raise InputError(f"{where}: it holds no measured number. Add a line and a quantity.")
    yield from several


def _quantities(
    names: Sequence[str], subject: Subject, mooring: Mooring, where: str
) -> list[Quantity]:
    own = OF_A_PANEL if isinstance(subject, Panel) else OF_A_CAGE
    conditions = ("current_speed_m_s", "law", "may_miss", "note", *own)
    quantities = [
        quantity_named(name, subject, where, mooring=mooring)
        for name in names
        if name not in conditions and not name.startswith(UNCERTAINTY)
    ]
    for name in names:
        if name.startswith(UNCERTAINTY):
            _one_of(name, [UNCERTAINTY + q.name for q in quantities], f"{where}: column")
    return quantities


def _numbers(
    line: Mapping[str, str], quantities: Sequence[Quantity], where: str
) -> Iterator[Measured]:
    """The numbers of one line; an empty cell was not measured."""
    law = _law(line["law"], f"{where}: law") if line.get("law") else None
    may_miss = _one_of(line.get("may_miss") or "no", ["yes", "no"], f"{where}: may_miss") == "yes"
    for quantity in quantities:
        value = _number(line, quantity.name, where)
        if value is None:
            continue
        yield Measured(
            at=_conditions(line, where),
            law=law,
            quantity=quantity,
            value=value,
            digit=10.0 ** int(Decimal(line[quantity.name]).as_tuple().exponent),
            may_miss=may_miss,
            uncertainty=_number(line, UNCERTAINTY + quantity.name, where) or 0.0,
            note=line.get("note") or "",
        )


def _conditions(line: Mapping[str, str], where: str) -> Conditions:
    angle = _number(line, "angle_deg", where)
    try:
        sea = SeaState(
            current_speed=_number(line, "current_speed_m_s", where) or 0.0,
            current_to=_number(line, "current_to_deg", where) or 0.0,
            hs=_number(line, "hs_m", where) or 0.0,
            tp=_number(line, "tp_s", where),
            wave_from=_number(line, "wave_from_deg", where) or 0.0,
        )
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    height, period = (_number(line, name, where) for name in ("wave_height_m", "wave_period_s"))
    if (height is None) != (period is None) or (height is not None and sea.hs > 0.0):
        raise InputError(
            f"{where}: regular waves have wave_height_m and wave_period_s, and no hs_m; irregular "
            "ones have hs_m and tp_s. Leave the other cells empty."
        )
    return Conditions(
        water=Water(sea=sea, height=height or 0.0, period=period or 0.0),
        angle=90.0 if angle is None else angle,
        solidity=_number(line, "solidity", where),
    )


def _number(line: Mapping[str, str], name: str, where: str) -> float | None:
    """A cell's number; None where it is empty or there is no such column."""
    if not line.get(name):
        return None
    try:
        return float(line[name])
    except ValueError as error:
        raise InputError(
            f"{where}: {name} = {line[name]!r} is no number. Write it with a decimal point, or "
            "leave the cell empty."
        ) from error
