"""The cases under ``cases/``: ours, and those that a user adds."""

from collections.abc import Iterator
from dataclasses import fields
from functools import partial

import numpy as np

from seacage.conventions import Result
from seacage.dynamics import Law, Response, settle
from seacage.ocean import SeaState
from validation._case import Case, Measured, read_cases
from validation._row import Row, Section, Span

Answers = dict[tuple[int, Law, SeaState], Response]


def rows_of_case(case: Case) -> Iterator[Row]:
    """Each measured number beside what the cage, or the span of an ensemble, gives."""
    answers = _answers(case)
    for measured in case.measured:
        ours = [
            _read(measured, answers[cage, law, measured.sea])
            for cage in range(len(case.cages))
            for law in _laws(case, measured)
        ]
        yield _row(case, measured, ours)


def _answers(case: Case) -> Answers:
    """Every cage of the case in every sea it was measured in, by every law asked for there."""
    answers: Answers = {}
    for law, seas in _asked(case).items():
        for number, cage in enumerate(case.cages):
            response = settle(
                cage,
                seas,
                law=law,
                hold_collar=case.hold_collar,
                collar_drag=case.pipe_drag,
                wake=case.wake,
            )
            answers |= {(number, law, sea): _one(response, i) for i, sea in enumerate(seas)}
    return answers


def _asked(case: Case) -> dict[Law, list[SeaState]]:
    asked: dict[Law, list[SeaState]] = {}
    for measured in case.measured:
        for law in _laws(case, measured):
            if measured.sea not in asked.setdefault(law, []):
                asked[law].append(measured.sea)
    return asked


def _laws(case: Case, measured: Measured) -> list[Law]:
    """The law of the line, or all of the case's."""
    return [measured.law] if measured.law else list(case.laws)


def _one(response: Response, case: int) -> Response:
    values = {field.name: getattr(response, field.name) for field in fields(Response)}
    return Response(**{name: np.asarray(value[case]) for name, value in values.items()})


def _read(measured: Measured, response: Response) -> float:
    if response.result != Result.CONVERGED:
        return float("nan")  # a shape that is not at rest proves nothing
    return measured.quantity.read(response, measured.sea)


def _row(case: Case, measured: Measured, ours: list[float]) -> Row:
    quantity, tolerance = measured.quantity, case.tolerance[measured.quantity.name]
    conditions = [f"{measured.sea.current_speed:g} m/s"]
    if measured.sea.current_to:
        conditions.append(f"to {measured.sea.current_to:g}°")
    if measured.law:
        conditions.append(measured.law)
    spread, value = measured.uncertainty, measured.value
    settled = [number for number in ours if not np.isnan(number)]
    unsettled = len(ours) - len(settled)
    return Row(
        what=f"{case.title}: {quantity.what}, {', '.join(conditions)}",
        unit=quantity.unit,
        reference=(value - spread, value + spread) if spread else value,
        ours=_span(settled),
        kind=case.kind,
        source=case.source,
        tolerance=tolerance.share * abs(value) + tolerance.fixed,
        reason=tolerance.reason,
        must_hold=case.must_hold,
        detail=f"{unsettled} of {len(ours)} did not settle" if unsettled else "",
        note=measured.note or case.note,
    )


def _span(numbers: list[float]) -> Span:
    if len(numbers) > 1:
        return min(numbers), max(numbers)
    return numbers[0] if numbers else float("nan")


def _section(case: Case) -> Section:
    return Section(
        title=case.title,
        about=case.about or f"The case `validation/cases/{case.name}`.",
        rows=partial(rows_of_case, case),
        slow=len(case.cages) > 1,  # far corners of an ensemble are slow to settle
    )


SECTIONS = tuple(_section(case) for case in read_cases())
