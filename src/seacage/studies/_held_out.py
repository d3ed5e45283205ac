"""A trained twin against a record that did not teach it."""

import json
from dataclasses import asdict, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from seacage.conventions import InputError
from seacage.figures import density_figure, series_figure, write_figure
from seacage.records import FieldRecord, Record
from seacage.studies._report import comparison_of
from seacage.studies._scores import SensorScore, compared, people_unit, score_sensor
from seacage.twin import Lesson, Twin

_ALWAYS = (datetime.min.replace(tzinfo=UTC), datetime.max.replace(tzinfo=UTC))
_BLOCKS = 8
_LONGEST_BLOCK_H = 24.0


def score_record(
    twin: Twin, field: FieldRecord, *, out: str | Path | None = None, seed: int = 0
) -> tuple[SensorScore, ...]:
    """Score a twin on what the sensors of a field record say.

    Of a sensor that taught the twin only the readings after its lesson count, or before it
    where there are none after.

    Parameters
    ----------
    twin, field
        Who answers, and what is true.
    out
        Folder for ``scores.json`` and the figures of each sensor; None writes nothing.
    seed
        Of the bootstrap.

    Raises
    ------
    InputError
        A sensor of the record has no reading that did not teach.
    """
    unseen = replace(
        field,
        sensors={
            name: _unseen(sensor, twin.provenance.lessons.get(name))
            for name, sensor in field.sensors.items()
            if name in twin.sensor_names
        },
    )
    answer = twin.predict_record(field.buoy)
    readings = compared(answer, unseen)
    scores = tuple(
        score_sensor(
            name,
            read,
            unit=people_unit(answer, name)[0],
            origin=field.sensors[name].origin,
            block_h=_block_h(read.time),
            seed=seed,
        )
        for name, read in readings.items()
    )
    if out is not None:
        folder = Path(out)
        folder.mkdir(parents=True, exist_ok=True)
        text = json.dumps([asdict(score) for score in scores], indent=2)
        (folder / "scores.json").write_text(text + "\n", encoding="utf-8")
        for score in scores:
            shown = comparison_of(score, readings[score.sensor])
            start, end = shown.time[0], shown.time[-1] + np.timedelta64(1, "s")
            write_figure(density_figure(shown), folder / f"{score.sensor}-density.svg")
            series = series_figure(shown, start=start, end=end)
            write_figure(series, folder / f"{score.sensor}-series.svg")
    return scores


def _unseen(sensor: Record, lesson: Lesson | None) -> Record:
    if lesson is None:
        return sensor
    first, last = _ALWAYS
    after, before = sensor.between(lesson.end, last), sensor.between(first, lesson.start)
    if not len(after) and not len(before):
        raise InputError(
            f"{sensor.stream}: all its readings lie in the window that taught the twin. "
            "Give a record that goes on after it."
        )
    return after if len(after) else before


def _block_h(time: np.ndarray) -> float:
    """A day, or an eighth of a record that is shorter than eight of them [h]."""
    span_h = float((time[-1] - time[0]) / np.timedelta64(1, "h"))
    return min(_LONGEST_BLOCK_H, max(span_h / _BLOCKS, 1.0))
