"""The cases under ``cases/``: ours, and those that a user adds."""

from collections.abc import Iterator
from functools import partial
from typing import Any

from seacage.cage import Structure
from seacage.dynamics import LAWS
from validation._answers import Water, answers
from validation._case import Case, Measured, read_cases
from validation._panel import PANEL_LAWS, Panel
from validation._row import Row, Section, Span

Found = dict[tuple[int, str, Water], Any]
"""What each member of the ensemble does, by each law, in each water."""


def rows_of_case(case: Case) -> Iterator[Row]:
    """Each measured number beside what the cage, or the span of an ensemble, gives."""
    found = _found(case)
    for measured in case.measured:
        several = [
            found[number, law, measured.at.water]
            for number in range(len(case.subjects))
            for law in _laws(case, measured)
        ]
        ours = [measured.quantity.read(one, measured.at) for one in several if one is not None]
        yield _row(case, measured, ours, unsettled=len(several) - len(ours))


def _found(case: Case) -> Found:
    found: Found = {}
    for law, waters in _waters_by_law(case).items():
        for number, subject in enumerate(case.subjects):
            if isinstance(subject, Panel):
                several: list[Any] = [PANEL_LAWS[law]] * len(waters)
            else:
                several = [*answers(subject, waters, law, case.how)]
            found |= {(number, law, at): one for at, one in zip(waters, several, strict=True)}
    return found


def _waters_by_law(case: Case) -> dict[str, list[Water]]:
    requests: dict[str, list[Water]] = {}
    for measured in case.measured:
        for law in _laws(case, measured):
            if measured.at.water not in requests.setdefault(law, []):
                requests[law].append(measured.at.water)
    return requests


def _laws(case: Case, measured: Measured) -> list[str]:
    """The law of the line, or all of the case's."""
    return [measured.law] if measured.law else list(case.laws)


def _row(case: Case, measured: Measured, ours: list[float], *, unsettled: int) -> Row:
    quantity, tolerance = measured.quantity, case.tolerance[measured.quantity.name]
    spread, value = measured.uncertainty, measured.value
    whole = len(ours) + unsettled
    return Row(
        what=f"{case.title}: {quantity.what}, {', '.join(_conditions(measured))}",
        unit=quantity.unit,
        reference=(value - spread, value + spread) if spread else value,
        ours=_span(ours),
        kind=case.kind,
        source=case.source,
        tolerance=tolerance.share * abs(value)
        + tolerance.fixed
        + tolerance.last_digits * measured.digit,
        reason=tolerance.reason,
        must_hold=case.must_hold and not measured.may_miss,
        detail=f"{unsettled} of {whole} did not settle" if unsettled else "",
        note=measured.note or case.note,
    )


def _conditions(measured: Measured) -> Iterator[str]:
    at, water = measured.at, measured.at.water
    sea = water.sea
    yield f"{sea.current_speed:g} m/s"
    if sea.current_to:
        yield f"to {sea.current_to:g}°"
    if sea.hs:
        yield f"Hs {sea.hs:g} m and Tp {sea.tp:g} s from {sea.wave_from:g}°"
    if water.height:
        yield f"waves of {water.height:g} m and {water.period:g} s from {sea.wave_from:g}°"
    if at.angle != 90.0:
        yield f"{at.angle:g}° to the flow"
    if at.solidity is not None:
        yield f"solidity {at.solidity:g}"
    if measured.law:
        yield measured.law


def _span(numbers: list[float]) -> Span:
    if len(numbers) > 1:
        return min(numbers), max(numbers)
    return numbers[0] if numbers else float("nan")


def _section(case: Case) -> Section:
    laws = _waters_by_law(case)
    simulated = any(law not in LAWS or any(at.has_waves for at in laws[law]) for law in laws)
    of_panel = isinstance(case.subjects[0], Panel)
    slow = simulated or isinstance(case.subjects[0], Structure)
    return Section(
        title=case.title,
        about=case.about or f"The case `validation/cases/{case.name}`.",
        rows=partial(rows_of_case, case),
        slow=slow and not of_panel,
    )


SECTIONS = tuple(_section(case) for case in read_cases())
