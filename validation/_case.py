"""A case that a user adds: one TOML on the cage and its source, one CSV of what was measured."""

import csv
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import product
from pathlib import Path
from typing import Any

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import LAWS, Law
from seacage.ocean import SeaState
from validation._quantities import Quantity, quantity_named
from validation._row import Kind

CASES = Path(__file__).parent / "cases"
KEYS: dict[str, type] = {
    "title": str,
    "about": str,
    "kind": str,
    "source": str,
    "cage": str,
    "laws": list,
    "collar": str,
    "pipe_drag": bool,
    "wake": bool,
    "must_hold": bool,
    "note": str,
    "changes": dict,
    "ensemble": dict,
    "tolerance": dict,
}
NEEDED = ("title", "kind", "source", "cage", "tolerance")
CONDITIONS = ("current_speed_m_s", "current_to_deg", "law", "note")
UNCERTAINTY = "uncertainty:"


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """A share of the measured value and a fixed part, in the quantity's unit, and why."""

    share: float
    fixed: float
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """One number of the CSV and the water it was measured in."""

    sea: SeaState
    law: Law | None  # None: the case's
    quantity: Quantity
    value: float
    uncertainty: float
    note: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A case as its two files describe it.

    Attributes
    ----------
    cages
        All that the ensemble spans; one where the cage is known.
    """

    name: str
    title: str
    about: str
    kind: Kind
    source: str
    cages: Sequence[Cage]
    laws: Sequence[Law]
    hold_collar: bool
    pipe_drag: bool
    wake: bool
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
    cage = _cage(folder, table["cage"], where)
    cage = cage.altered(**table.get("changes", {}))
    tolerance = {key: _tolerance(key, entry, where) for key, entry in table["tolerance"].items()}
    measured = list(_measured(folder, cage))
    for number in measured:
        if number.quantity.name not in tolerance:
            raise InputError(
                f'{where}: measured.csv has {number.quantity.name}, but [tolerance."'
                f'{number.quantity.name}"] is missing. Add it, with share, fixed or both, and '
                "reason."
            )
    return Case(
        name=folder.name,
        title=table["title"],
        about=table.get("about", ""),
        kind=_one_of(table["kind"], [kind.value for kind in Kind], f"{where}: kind", Kind),
        source=table["source"],
        cages=list(_ensemble(cage, table.get("ensemble", {}), where)),
        laws=[_law(law, f"{where}: laws") for law in table.get("laws", LAWS)],
        hold_collar=_one_of(
            table.get("collar", "moored"), ["held", "moored"], f"{where}: collar", "held".__eq__
        ),
        pipe_drag=table.get("pipe_drag", True),
        wake=table.get("wake", True),
        must_hold=table.get("must_hold", False),
        note=table.get("note", ""),
        tolerance=tolerance,
        measured=measured,
    )


def _table(path: Path, where: str) -> dict[str, Any]:
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{where}: cannot read it as UTF-8 text ({error}).") from error
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{where}: this is not TOML ({error}). Mend the line it names.") from error
    for key in NEEDED:
        if key not in table:
            raise InputError(f"{where}: the key {key!r} is missing. Add it.")
    for key, value in table.items():
        _one_of(key, list(KEYS), f"{where}: key")
        if not isinstance(value, KEYS[key]):
            raise InputError(
                f"{where}: {key} must be a {KEYS[key].__name__}, not {value!r}. Mend it."
            )
    return table


def _one_of(value: str, known: Sequence[str], where: str, made: Any = str) -> Any:
    if value not in known:
        close = get_close_matches(str(value), known, n=1)
        hint = f"did you mean {close[0]!r}?" if close else f"known are: {', '.join(known)}."
        raise InputError(f"{where} {value!r} is unknown; {hint}")
    return made(value)


def _law(name: str, where: str) -> Law:
    return _one_of(name, LAWS, where)


def _cage(folder: Path, name: str, where: str) -> Cage:
    """A cage that comes with seacage, or a file beside the case."""
    if not name.endswith(".toml"):
        return Cage.named(name)
    if not (folder / name).is_file():
        raise InputError(f"{where}: there is no cage file {name} beside it. Put it there.")
    return Cage.read(folder / name)


def _ensemble(cage: Cage, choices: Mapping[str, Any], where: str) -> Iterator[Cage]:
    """Each combination of the choices, as a changed cage."""
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
        yield cage.altered(**changes)


def _tolerance(key: str, entry: Any, where: str) -> Tolerance:
    where = f'{where}: [tolerance."{key}"]'
    if not isinstance(entry, dict) or not isinstance(entry.get("reason"), str):
        raise InputError(f'{where}: the key reason is missing. Say why: reason = "…".')
    for name, value in entry.items():
        _one_of(name, ["share", "fixed", "reason"], f"{where}: key")
        if name != "reason" and not (isinstance(value, int | float) and value >= 0.0):
            raise InputError(f"{where}: {name} = {value!r} must be a number of at least 0.")
    share, fixed = float(entry.get("share", 0.0)), float(entry.get("fixed", 0.0))
    return Tolerance(share=share, fixed=fixed, reason=entry["reason"])


def _measured(folder: Path, cage: Cage) -> Iterator[Measured]:
    path = folder / "measured.csv"
    if not path.is_file():
        raise InputError(f"{folder.name}: measured.csv is missing beside case.toml. Add it.")
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        names = list(reader.fieldnames or ())
        if "current_speed_m_s" not in names:
            raise InputError(
                f"{folder.name}/measured.csv: the column current_speed_m_s is missing. Add it: "
                "each line is one current."
            )
        where = f"{folder.name}/measured.csv"
        quantities = [
            quantity_named(name, cage, where)
            for name in names
            if name not in CONDITIONS and not name.startswith(UNCERTAINTY)
        ]
        for name in names:
            if name.startswith(UNCERTAINTY):
                _one_of(name, [UNCERTAINTY + q.name for q in quantities], f"{where}: column")
        for line in reader:
            yield from _numbers(line, quantities, f"{where}, line {reader.line_num}")


def _numbers(
    line: Mapping[str, str], quantities: Sequence[Quantity], where: str
) -> Iterator[Measured]:
    """The numbers of one line; an empty cell was not measured."""
    speed = _number(line, "current_speed_m_s", where)
    to = _number(line, "current_to_deg", where) if line.get("current_to_deg") else 0.0
    law = _law(line["law"], f"{where}: law") if line.get("law") else None
    for quantity in quantities:
        if not line[quantity.name]:
            continue
        spread = UNCERTAINTY + quantity.name
        yield Measured(
            sea=SeaState(current_speed=speed, current_to=to),
            law=law,
            quantity=quantity,
            value=_number(line, quantity.name, where),
            uncertainty=_number(line, spread, where) if line.get(spread) else 0.0,
            note=line.get("note") or "",
        )


def _number(line: Mapping[str, str], name: str, where: str) -> float:
    try:
        return float(line[name])
    except (TypeError, ValueError) as error:
        raise InputError(
            f"{where}: {name} = {line[name]!r} is no number. Write it with a decimal point, or "
            "leave the cell empty."
        ) from error
