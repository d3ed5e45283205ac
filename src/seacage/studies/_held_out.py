"""Scores of a twin on held-out days of a field record, and the figures that go with them."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from seacage.figures import Comparison, density_figure, series_figure, write_figure
from seacage.records import FieldRecord
from seacage.studies._page import write_scores
from seacage.studies._sensor_scores import Answers, Readings, SensorScore, compare, score_sensor
from seacage.studies._split import unseen
from seacage.twin import Twin

SHOWN_DAYS = 5  # a series shows so many unseen days; the scores take them all
_BREAK = np.timedelta64(12, "h")  # a silence as long breaks a series: what was between is not known


def score_record(
    twin: Twin, field: FieldRecord, *, out: str | Path | None = None, seed: int = 0
) -> tuple[SensorScore, ...]:
    """Score a twin on the days of a field record that it was not trained on.

    ``twin``: its provenance holds the training window of each sensor.
    ``field``: the record that it was trained on, whose later days are scored, or another.
    ``out``: folder for ``scores.json``, and per sensor a density scatter and a time series of both
    fidelities (SVG); None writes nothing.
    ``seed``: of the bootstrap.

    Raises InputError: a sensor of the record has no held-out day.
    """
    judging = unseen(field, twin.provenance.training_windows)
    readings = compare(Answers.of(twin, field.buoy), judging)
    scores = tuple(score_sensor(one, seed=seed) for one in readings.values())
    if out is not None:
        _write(Path(out), scores, readings)
    return scores


def comparison(score: SensorScore, readings: Readings) -> Comparison:
    """A sensor's readings and scores, as its figures take them."""
    return Comparison(
        sensor=score.sensor,
        quantity="Depth" if score.unit == "m" else "Tension",
        unit=score.unit,
        time=readings.time,
        reading=readings.reading,
        low=readings.low,
        multi=readings.multi,
        multi_std=np.where(readings.level > 1, readings.multi_std, np.nan),
        low_mae=score.raw.low_mae,
        multi_mae=score.raw.multi_mae,
        low_line=score.low_line,
        multi_line=score.multi_line,
        origin=score.origin,
    )


def display_span(readings: Readings) -> tuple[np.datetime64, np.datetime64]:
    """Start and end of the time that a series shows: the first days of the longest part unbroken.

    A part ends where nothing was read for hours.
    """
    breaks = np.flatnonzero(np.diff(readings.time) > _BREAK)
    first = np.concatenate([[0], breaks + 1])
    last = np.concatenate([breaks, [len(readings.time) - 1]])
    longest = int(np.argmax(readings.time[last] - readings.time[first]))
    start, until = readings.time[[first[longest], last[longest]]]
    return start, min(until + np.timedelta64(1, "us"), start + np.timedelta64(SHOWN_DAYS, "D"))


def _write(out: Path, scores: Sequence[SensorScore], readings: Mapping[str, Readings]) -> None:
    out.mkdir(parents=True, exist_ok=True)
    write_scores(out / "scores.json", {"sensors": scores})
    for score in scores:
        drawn = comparison(score, readings[score.sensor])
        start, end = display_span(readings[score.sensor])
        write_figure(density_figure(drawn), out / f"{score.sensor}-density.svg")
        write_figure(series_figure(drawn, start=start, end=end), out / f"{score.sensor}-series.svg")
