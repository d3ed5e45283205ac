"""A stream with what its quality checks flagged."""

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.conventions import Flag
from seacage.figures._comparison import date_axis
from seacage.figures._style import FIT, SENSOR, head, page
from seacage.figures._types import Axes, Figure
from seacage.records import Record, is_direction, key_of, plain_key

_SUSPECT = "#b8860b"
_MISSING = "#2f74b5"
_LABELS = {
    "current_speed_m_s": "Current speed",
    "current_to_deg": "Current to",
    "hs_m": "Wave height",
    "tp_s": "Peak period",
    "wave_from_deg": "Waves from",
    "tension_kn": "Tension",
    "depth_m": "Depth",
}
_DRAWN = 4000  # points of the line, at most about; of each kind of mark, half as many


def quality_figure(record: Record) -> Figure:
    """Every quantity over time: what came, and where it is suspect, failed or missing.

    The line breaks where the stream was silent for ten times its usual step. A failed value
    outside the picture of the others stands at its edge. Where there are too many readings to
    draw, the line goes through the least and the greatest of short spans.
    """
    keys = tuple(record.values)
    with page(10.0, 0.6 + 1.9 * len(keys)) as figure:
        panels = figure.subplots(len(keys), 1, sharex=True, squeeze=False)[:, 0]
        for axes, key in zip(panels, keys, strict=True):
            _panel(axes, record, key)
        head(panels[0], record.stream, origin=record.origin, legend=4)
        date_axis(panels[-1], "Time [UTC]")
    return figure


def _panel(axes: Axes, record: Record, key: str) -> None:
    values, flags = record.values[key], record.flags[key]
    kept = record.usable(key)
    low, high = _limits(values[kept] if np.any(kept) else values[np.isfinite(values)], key)
    time, line = _thin(record.time[kept], values[kept])
    turning, known = is_direction(key), key_of(key)
    assert known is not None  # the record refused it
    depth = known.long_name.partition(", at ")[2]
    axes.plot(
        *(_broken(time, line) if not turning else (time, line)),
        color=SENSOR,
        lw=0.0 if turning else 0.7,
        marker="." if turning else "",
        ms=1.6,
        label="Reading",
    )
    for flag, colour, marker, label in (
        (Flag.SUSPECT, _SUSPECT, "^", "Suspect"),
        (Flag.FAIL, FIT, "x", "Fail"),
        (Flag.MISSING, _MISSING, "|", "Missing"),
    ):
        rows = _some(flags == flag)
        shown = np.full(len(rows), low) if flag == Flag.MISSING else np.nan_to_num(values[rows])
        axes.plot(
            record.time[rows],
            np.clip(shown, low, high),
            color=colour,
            marker=marker,
            ms=6.0 if flag == Flag.MISSING else 4.2,
            mew=1.1,
            ls="",
            label=label,
            # An empty line that is not clipped lies in 1970, and the layout makes room for it.
            clip_on=not len(rows),
        )
    axes.set(
        ylim=(low, high), ylabel=f"{_LABELS[plain_key(key)]} {depth}".rstrip() + f" [{known.unit}]"
    )
    axes.margins(x=0.01)


def _limits(values: Float[np.ndarray, " t"], key: str) -> tuple[float, float]:
    if is_direction(key):
        return 0.0, 360.0
    if not values.size:
        return 0.0, 1.0
    low, high = float(np.min(values)), float(np.max(values))
    margin = 0.06 * (high - low) or 0.5
    return low - margin, high + margin


def _thin(
    time: Shaped[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> tuple[Shaped[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    """The least and the greatest of spans so short that few points are left."""
    if len(values) <= _DRAWN:
        return time, values
    span = -(-2 * len(values) // _DRAWN)
    spans = ((start, values[start : start + span]) for start in range(0, len(values), span))
    ends = [(start + int(some.argmin()), start + int(some.argmax())) for start, some in spans]
    rows = np.unique(ends)
    return time[rows], values[rows]


def _broken(
    time: Shaped[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> tuple[Shaped[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    if len(time) < 3:
        return time, values
    steps = np.diff(time)
    silent = np.flatnonzero(steps > 10 * np.median(steps)) + 1
    return np.insert(time, silent, time[silent]), np.insert(values, silent, np.nan)


def _some(marked: Bool[np.ndarray, " t"]) -> Shaped[np.ndarray, " row"]:
    """Marked rows: the first of each run, and of the others so many as can be drawn."""
    rows = np.flatnonzero(marked)
    begins = rows[np.diff(rows, prepend=-2) > 1]
    return np.union1d(begins, rows[:: -(-2 * len(rows) // _DRAWN) or 1])
