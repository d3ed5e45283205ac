"""Loads of the lines of a mooring: statistics, extremes, slack, snaps and fatigue."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import MooringLines
from seacage.conventions import YEAR
from seacage.dynamics._moored._ends import SLACK
from seacage.dynamics._time._extremes import Extremes, Series, extremes
from seacage.dynamics._time._statistics import Statistics

FREQUENCY = 1.0  # of the equivalent load's cycles [Hz]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LineLoads:
    """Tensions of all ropes and chains that the model has; an anchor line's at its corner."""

    # The bridles first; "bridle", "frame line", "anchor line", "buoy line", or a structure's "line"
    names: tuple[str, ...]
    kinds: tuple[str, ...]
    # Breaking load over material factor; NaN where the file gives none [N]
    capacity: Float[np.ndarray, " line"]
    # m of the line's T–N curve; NaN where the file gives none [-]
    tn_slope: Float[np.ndarray, " line"]
    tension: Statistics  # over all time steps, the quantiles from samples [N]
    # Of three hours [N], from tensions every 0.1 s; a buoy line's are no more than its buoyancy
    extremes: Extremes
    # Share of the time below a hundredth of the pretension; NaN where that is not known [-]
    slack_share: Float[np.ndarray, "*case line"]
    # Times that a slack line was pulled taut, beyond its mean tension; NaN as above
    snaps: Float[np.ndarray, "*case line"]
    # Mean pull of an anchor line on its anchor, east, north and up; NaN for other lines [N]
    anchor_pull: Float[np.ndarray, "*case line 3"]
    # Largest pull up on the anchor; NaN as above [N]
    uplift_maximum: Float[np.ndarray, "*case line"]
    # Range of cycles at 1 Hz that wear the line as much, for ``tn_slope`` [N]
    damage_equivalent: Float[np.ndarray, "*case line"]
    # Share of the T–N life that a year of such a sea uses up; NaN without an intercept [1/a]
    damage_per_year: Float[np.ndarray, "*case line"]

    @property
    def columns(self) -> dict[str, Float[np.ndarray, "*case line"]]:
        """Each number of the lines by the name that files and tables give it."""
        kinds = ("mean", "std", "minimum", "maximum")
        return {
            "capacity": self.capacity,
            **{kind: getattr(self.tension, kind) for kind in kinds},
            "mpm_3h": self.extremes.mpm,
            "mpm_3h_std": self.extremes.mpm_std,
            "expected_3h": self.extremes.expected,
            "expected_3h_std": self.extremes.expected_std,
            "slack_share": self.slack_share,
            "snaps": self.snaps,
            "uplift_mean": self.anchor_pull[..., 2],
            "uplift_maximum": self.uplift_maximum,
            "damage_equivalent": self.damage_equivalent,
            "damage_per_year": self.damage_per_year,
            "tn_slope": self.tn_slope,
        }

    @property
    def utilisation(self) -> Float[np.ndarray, "*case line"]:
        """Largest tension over capacity [-]."""
        return self.tension.maximum / self.capacity


def line_loads(
    lines: MooringLines,
    statistics: Statistics,
    tension: Series,
    *,
    anchor_pull: Float[np.ndarray, "line 3"],
    uplift: Float[np.ndarray, " line"],
    most: Float[np.ndarray, " line"],
    every: float,
    waves: bool,
) -> LineLoads:
    """Of one simulation, from its statistics and its tensions ``every`` so many seconds.

    No line bears more than ``most``: for a buoy line all its buoy's buoyancy [N].
    """
    slack = tension < SLACK * lines.pretension
    known = np.isfinite(lines.pretension)
    snaps = [_snaps(slack[:, line], tension[:, line]) for line in range(len(known))]
    tail = extremes([tension], every=every, has_waves=waves)
    equivalent = damage_equivalent_load([tension], lines.tn_slope, every=every)
    mpm, expected = np.minimum(tail.mpm, most), np.minimum(tail.expected, most)
    return LineLoads(
        names=lines.names,
        kinds=lines.kinds,
        capacity=lines.capacity,
        tn_slope=lines.tn_slope,
        tension=statistics,
        extremes=replace(tail, mpm=mpm, expected=expected),
        slack_share=np.where(known, slack.mean(axis=0), np.nan),
        snaps=np.where(known, snaps, np.nan),
        anchor_pull=anchor_pull,
        uplift_maximum=uplift,
        damage_equivalent=equivalent,
        damage_per_year=YEAR * lines.damage_rate(equivalent),
    )


def _snaps(slack: Bool[np.ndarray, " t"], tension: Float[np.ndarray, " t"]) -> int:
    """Times that a line goes from slack to a peak beyond its mean before it is slack again."""
    taut = np.flatnonzero(slack[:-1] & ~slack[1:]) + 1
    if not len(taut):
        return 0
    return int(np.sum(np.maximum.reduceat(tension, taut) > tension.mean(dtype=np.float64)))


def damage_equivalent_load(
    tension: Sequence[Series], slope: Float[np.ndarray, " line"], *, every: float
) -> Float[np.ndarray, " line"]:
    """Range of the constant cycles at 1 Hz that wear each line as its own tension does [N].

    (Σ nᵢ ΔTᵢᵐ / (1 Hz · duration))^(1/m), the cycles counted by rainflow, half cycles as halves.
    Left out: the effect of the mean tension, bending over the fairlead, and corrosion.

    ``tension``: of each simulation of one sea [N].
    ``slope``: m of each line's T–N curve, NaN where there is none, which gives NaN [-].
    ``every``: between samples [s].

    Source: rainflow: ASTM E1049-85 (2011), 5.4.4.
    """
    duration = every * sum(map(len, tension))
    load = np.full(len(slope), np.nan)
    for line in np.flatnonzero(np.isfinite(slope)):
        m = slope[line]
        cycles = np.concatenate([_cycles(one[:, line]) for one in tension])
        # over the largest range, or a slope of 13 leaves the finite numbers
        largest = max(cycles[:, 0].max(initial=0.0), np.finfo(float).tiny)
        damage = np.sum(cycles[:, 1] * (cycles[:, 0] / largest) ** m)
        load[line] = largest * (damage / (FREQUENCY * duration)) ** (1.0 / m)
    return load


def _cycles(series: Float[np.ndarray, " t"]) -> Float[np.ndarray, "cycle 2"]:
    """Range and count, 1 or 1/2, of each rainflow cycle."""
    import rainflow

    change = np.sign(np.diff(series))
    moving = np.flatnonzero(change)
    turns = moving[1:][change[moving[1:]] != change[moving[:-1]]]  # all but these it would skip
    reversals = series[np.concatenate([[0], turns, [len(series) - 1]])].astype(np.float64)
    found = [(size, count) for size, _, count, _, _ in rainflow.extract_cycles(reversals.tolist())]
    return np.array(found).reshape(-1, 2)
