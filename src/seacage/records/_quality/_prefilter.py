"""Which rows of a record need the tests one by one: all others are certainly good.

No flag is given here. A row that might fail a test, be it by a hair of rounding, goes to
``evaluate``, with the rows before it that its evaluation depends on.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import GRAVITY, Flag, towards
from seacage.records._quality import _tests
from seacage.records._quality._limits import GROUPS, Limits, Range, Steadiness

_HAIR = 1e-6  # far above what two ways of rounding differ by, as a share of the numbers
_GENTLEST = 1.0 / 25.0  # no sea that steep or less is refused, whatever its period
Rows = Int[np.ndarray, " row"]
Columns = Mapping[str, Float[np.ndarray, " t"]]


class Candidates(NamedTuple):
    """The rows of one group's readings that a test may flag."""

    stretches: list[slice]
    """Rows, ascending. Each stretch may be evaluated as if nothing came before it."""
    faint: Bool[np.ndarray, " t"]
    """Where the signal may be attenuated. A stretch that begins late might say so elsewhere."""


class _Chain(NamedTuple):
    """The readings that are compared with each other: all but those that fail by themselves."""

    row: Rows
    time: Int[np.ndarray, " reading"]
    joined: Bool[np.ndarray, " step"]  # of each reading but the first: no gap lies before it
    value: Float[np.ndarray, "key reading"]
    point: Float[np.ndarray, "axis reading"]


class _Span(NamedTuple):
    """Readings that may be flagged, and the reading from which their evaluation must begin."""

    begin: Rows
    reading: Rows


def candidate_rows(
    group: str,  # such as ``depth``
    time: Int[np.ndarray, " t"],  # ascending [us]
    columns: Columns,  # the group's values by door key, one at least
    limits: Limits,  # for the tests
) -> Candidates:
    """Where in one group's readings a test may find something."""
    if not len(time):
        return Candidates([], np.zeros(0, dtype=bool))
    steadiness = limits.steadiness[group]
    with np.errstate(over="ignore", invalid="ignore"):  # absurd values are candidates
        alone = np.flatnonzero(~_surely_good_alone(columns, limits))
        chain = _chain(group, time, columns, limits, alone)
        faint = _faint(chain, steadiness)
        spans = [_changing(chain, steadiness), _still(chain, steadiness), faint]
    begins = np.concatenate([alone, *(chain.row[span.begin] for span in spans)])
    ends = np.concatenate([alone, *(chain.row[span.reading] for span in spans)]) + 1
    mask = np.zeros(len(time), dtype=bool)
    mask[chain.row[faint.reading]] = True
    return Candidates(_join(begins, ends, len(time)), mask)


def _join(begins: Rows, ends: Rows, length: int) -> list[slice]:
    """Stretches that cover all others, from each begin up to its end."""
    size = length + 1
    depth = np.cumsum(np.bincount(begins, minlength=size) - np.bincount(ends, minlength=size))
    edges = np.flatnonzero(np.diff(depth > 0, prepend=False)).reshape(-1, 2)
    return [slice(first, end) for first, end in edges.tolist()]


def _surely_good_alone(columns: Columns, limits: Limits) -> Bool[np.ndarray, " t"]:
    """Where no value is out of any range, of whatever month, and no sea is near too steep."""
    good = [
        _within(column, span)
        for key, column in columns.items()
        for span in (
            limits.ranges[key],
            *(season.range for season in limits.climatology.get(key, ())),
        )
    ]
    if {"hs_m", "tp_s"} <= columns.keys():
        hs, square = columns["hs_m"], columns["tp_s"] ** 2
        steepest = (1.0 - _HAIR) * _GENTLEST * GRAVITY / (2.0 * np.pi) * square
        good.append((hs <= 0.0) | (hs <= steepest))
    return np.all(good, axis=0)


def _within(column: Float[np.ndarray, " t"], span: Range) -> Bool[np.ndarray, " t"]:
    (low, high), (lowest, highest) = span.suspect, span.fail
    return (max(low, lowest) <= column) & (column <= min(high, highest))


def _chain(
    group: str, time: Int[np.ndarray, " t"], columns: Columns, limits: Limits, alone: Rows
) -> _Chain:
    compared = np.ones(len(time), dtype=bool)
    for row in alone.tolist():
        values = {key: float(column[row]) for key, column in columns.items()}
        findings = _tests.evaluate_alone(group, int(time[row]), values, limits)
        compared[row] = all(finding.flag < Flag.FAIL for finding in findings)
    rows = np.flatnonzero(compared)
    kept = {key: column[rows] for key, column in columns.items()}
    return _Chain(
        row=rows,
        time=time[rows],
        joined=np.diff(time[rows]) <= limits.steadiness[group].gap_s * _tests.SECOND,
        value=np.array(list(kept.values())),
        point=_points(group, kept),
    )


def _points(group: str, columns: Columns) -> Float[np.ndarray, "axis t"]:
    key, *others = GROUPS[group]
    if key not in columns:
        return np.empty((0, len(next(iter(columns.values())))))
    if group == "current" and others[0] in columns:
        return towards(columns[key], columns[others[0]]).T
    return columns[key][None]


def _changing(chain: _Chain, limits: Steadiness) -> _Span:
    """Readings after a gap, after a large change, or after what may have been a spike."""
    seconds = np.diff(chain.time) / _tests.SECOND
    change = np.sqrt(np.sum(np.diff(chain.point) ** 2, axis=0))
    size = np.sqrt(np.sum(chain.point**2, axis=0))
    most = change + _HAIR * (1.0 + size[1:] + size[:-1])
    calm = chain.joined & (most <= limits.jump + limits.rate * seconds)
    spike = np.minimum(most[1:], most[:-1]) <= min(limits.spike_suspect, limits.spike_fail)
    calm[1:] &= spike
    reading = 1 + np.flatnonzero(~calm)
    return _Span(np.maximum(reading - 2, 0), reading)


def _still(chain: _Chain, limits: Steadiness) -> _Span:
    """Readings that repeat those before them for long."""
    moved = np.ones(len(chain.row), dtype=bool)
    moved[1:] = ~chain.joined | np.any(chain.value[:, 1:] != chain.value[:, :-1], axis=0)
    since = np.maximum.accumulate(np.where(moved, np.arange(len(moved)), 0))
    count = 1 + np.arange(len(moved)) - since
    seconds = (chain.time - chain.time[since]) / _tests.SECOND
    reading = np.flatnonzero(
        (seconds >= min(limits.flat_suspect_s, limits.flat_fail_s))
        & (count >= min(_tests.FLAT_SUSPECT_COUNT, _tests.FLAT_FAIL_COUNT))
    )
    return _Span(since[reading], reading)


def _faint(chain: _Chain, limits: Steadiness) -> _Span:
    """Readings in a bucket at whose beginning the window's range is small.

    Within a bucket the range only grows: where it is large at first no reading may be flagged.
    """
    window = limits.attenuated_s * _tests.SECOND
    limit = max(limits.attenuated_suspect, limits.attenuated_fail)
    nothing = np.empty(0, dtype=np.int64)
    if not (len(chain.row) and len(chain.point) and np.isfinite(window) and limit > 0.0):
        return _Span(nothing, nothing)
    number = np.floor(chain.time / (window / _tests.BUCKETS))
    opens = np.concatenate([[0], 1 + np.flatnonzero(~chain.joined | (np.diff(number) != 0.0))])
    last = np.append(opens[1:], len(number)) - 1
    gap = np.concatenate([[0], 1 + np.flatnonzero(~chain.joined)])
    began = gap[np.searchsorted(gap, opens, side="right") - 1]
    oldest = np.searchsorted(chain.time[last], chain.time[opens] - window, side="right")
    oldest = np.maximum(oldest, np.searchsorted(opens, began))
    size = np.max(_range_over(chain.point, opens, oldest), axis=0)
    small = ~(size >= limit + _HAIR) & (chain.time[last] - chain.time[began] >= window)
    # One bucket more, so that the window is full where it is full for who judges all readings.
    begin = opens[np.maximum(oldest - 1, np.searchsorted(opens, began))]
    reading = np.flatnonzero(np.repeat(small, last - opens + 1))
    return _Span(np.repeat(begin[small], (last - opens + 1)[small]), reading)


def _range_over(
    point: Float[np.ndarray, "axis reading"],
    opens: Int[np.ndarray, " bucket"],
    oldest: Int[np.ndarray, " bucket"],
) -> Float[np.ndarray, "axis bucket"]:
    """Range of all readings from an oldest bucket up to each bucket's first reading."""
    here, first = np.arange(len(opens)), point[:, opens]
    pairs = np.column_stack([oldest, here]).ravel()
    low, high = (
        reduced.reduceat(reduced.reduceat(point, opens, axis=1), pairs, axis=1)[:, ::2]
        for reduced in (np.minimum, np.maximum)
    )
    size = np.maximum(high, first) - np.minimum(low, first)
    return np.where(oldest < here, size, 0.0)
