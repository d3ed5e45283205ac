"""The fidelity study: a virtual field held against the rules that keep it honest."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters
from seacage.conventions import InputError, Origin, Progress, no_progress
from seacage.records import FieldRecord
from seacage.studies._chain import Chain, Recipe
from seacage.studies._fidelity._claims import claims
from seacage.studies._fidelity._fouling import FoulingGap, fouling_gap
from seacage.studies._fidelity._gap import SensorGap, sensor_gaps
from seacage.studies._fidelity._null_case import NullCase, null_case
from seacage.studies._fidelity._report import page_values
from seacage.studies._fidelity._rescaling import Rescaling, rescalings
from seacage.studies._fidelity._windows import Sensors, Windows, answer_windows, choose_windows
from seacage.studies._page import write_report
from seacage.studies._text import Claim

_DAYS = 48.0  # of the field that is made where none is given
_POINTS = 300  # readings that each sensor teaches with at most, as a twin's do


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FidelityStudy:
    """Where the study's report is, and what it found."""

    # The HTML page and the same numbers as JSON
    report: Path
    scores: Path
    claims: tuple[Claim, ...]  # each with its verdict
    gaps: tuple[SensorGap, ...]  # low fidelity against the truth, by sensor
    rescalings: tuple[Rescaling, ...]  # what the best rescaling leaves, by sensor
    null: NullCase  # the null case beside the real one
    fouling: FoulingGap


def fidelity_study(
    out: str | Path,  # as for ``paper_study``, as are ``workers`` and ``progress``
    *,
    # Folder of a virtual field with its truth beside it in ``truth``; None makes one of 48 days,
    # settled and without waves
    field: str | Path | None = None,
    cage: Cage | None = None,  # that the field is of; None for the shipped cage of the field's name
    # That the field was made with, or is to be made with; None for those shipped
    hidden: TruthParameters | None = None,
    # 10-minute windows that survey the days, about; those in which a shackle lives come on top.
    # With waves a window costs half a second of a core.
    windows: int = 600,
    seed: int = 0,  # of the choice of windows, the low fidelity's waves, searches and draws
    workers: int | None = None,
    progress: Progress | None = None,
) -> FidelityStudy:
    """Show how far low fidelity and virtual field are apart, into one HTML page.

    Low fidelity against the truth per sensor and direction of the current; what its best
    rescaling and rotation leaves; that multifidelity gains nothing where the truth is the low
    fidelity itself; and how the gap changes with the net's growth.

    Raises InputError: the field is not virtual, was made with other hidden parameters, or is too
    short.
    """
    out, report = Path(out), progress or no_progress
    hidden = TruthParameters.read() if hidden is None else hidden
    if cage is None:
        cage = Cage.named("ace" if field is None else FieldRecord.read(field).cage)
    chain = Chain(
        folder=out / "stages",
        cage=cage,
        recipe=Recipe(seed=seed, days=_DAYS),
        given_field=None if field is None else Path(field),
        hidden=hidden,
        workers=workers,
        progress=report,
    )
    record, stages = chain.field, chain.stages
    _check(record, hidden, windows)
    chosen = choose_windows(Sensors.of(cage), record, chain.truth, count=windows, seed=seed)
    whole = answer_windows(chosen, stages, seed=seed)
    survey = whole.rows(whole.surveyed)
    gaps = sensor_gaps(survey, seed=seed)
    scaled = rescalings(survey, stages, seed=seed)
    null = null_case(whole, record, points=_POINTS, seed=seed, progress=report)
    fouling = fouling_gap(survey, hidden, stages, begin=record.buoy.time[0])
    found = claims(gaps, scaled, null, fouling)
    scores = {
        "recipe": _recipe(record, whole, lost=len(chosen) - len(whole)),
        "provenance": _provenance(record, cage, seed),
        "claims": found,
        "sensors": gaps,
        "rescalings": scaled,
        "null_case": null,
        "fouling": fouling,
    }
    values = page_values(gaps, scaled, null, fouling)
    written, numbers = write_report(out, "fidelity.html", scores, values)
    return FidelityStudy(
        report=written,
        scores=numbers,
        claims=found,
        gaps=gaps,
        rescalings=scaled,
        null=null,
        fouling=fouling,
    )


def _check(record: FieldRecord, hidden: TruthParameters, windows: int) -> None:
    if record.origin is not Origin.VIRTUAL_FIELD:
        raise InputError(
            f"study fidelity: the record's sensors are {record.origin}, and no truth is known of "
            "them. Give a folder that `seacage field virtual` made."
        )
    if record.hidden_sha256 != hidden.sha256:
        raise InputError(
            f"study fidelity: the field was made with hidden parameters {record.hidden_sha256}, "
            f"and these are {hidden.sha256}. Give the file that made it."
        )
    if windows < 1:
        raise InputError(f"study fidelity: windows = {windows} surveys nothing. Give e.g. 600.")


def _recipe(record: FieldRecord, windows: Windows, *, lost: int) -> dict[str, str]:
    days = len(np.unique(windows.day))
    surveyed = int(np.sum(windows.surveyed))
    how = (
        "simulated in time for 600 s after 300 s, in long-crested waves of the height, period and "
        "direction that the buoy reports, 16 side by side"
        if windows.waves
        else "settled, as the buoy reports no waves"
    )
    return {
        "Truth (virtual field)": f"{len(record.sensors)} sensors, "
        f"{_date(record.buoy.time[0])} to {_date(record.buoy.time[-1])}",
        "Windows": f"{surveyed} of 10 minutes spread over {days} days, each from its own share "
        f"of the day, and {len(windows) - surveyed} more in which a shackle lives",
        "Low fidelity (computed)": f"Kristiansen–Faltinsen screens on a clean net, uniform "
        f"current, frame on anchor lines; {how}; {lost} lost",
        "Days": "for the rescaling every other day trains; for the null case the first half "
        "trains, the second is scored",
    }


def _date(time: np.datetime64) -> str:
    return str(np.datetime_as_string(time, unit="m")).replace("T", " ")


def _provenance(record: FieldRecord, cage: Cage, seed: int) -> dict[str, str]:
    from importlib.metadata import version

    return {
        "seacage": version("seacage"),
        "Seed": str(seed),
        "Cage": f"{cage.name}, sha256 {cage.sha256}",
        "Hidden parameters": f"sha256 {record.hidden_sha256}",
        "Notes": "\n".join(record.notes),
    }
