"""How the gap between low fidelity and truth changes while the net grows."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from seacage.campaigns import Plan, TruthParameters
from seacage.conventions import no_progress
from seacage.studies._fidelity._windows import Windows
from seacage.studies._shape_discrepancy import without_drift
from seacage.studies._stages import Stages, count

SPEEDS = (0.3, 0.5, 0.7)  # of the currents that the gap is settled in [m/s]
GROWTHS = (0.0, 0.25, 0.5, 0.75, 1.0)  # shares of the whole growth [-]
_DAY = np.timedelta64(1, "D")
_BINS = 5
_LEAST = 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MetGap:
    """What the record has while the net is about as grown."""

    growth: float  # mean share of the whole growth [-]
    windows: int
    # Truth less low fidelity, in the mean over whatever the currents were [m] or [kN]
    gap: Float[np.ndarray, " sensor"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FoulingGap:
    """Truth less low fidelity, by how grown the net is: [m] of rise, [kN] of tension."""

    # Their names, and the units of their responses
    sensors: tuple[str, ...]
    units: tuple[str, ...]
    current_to: float  # where the settled currents go [deg]
    # At which the true cage was settled [-] and [m/s]
    growth: Float[np.ndarray, " growth"]
    speed: Float[np.ndarray, " speed"]
    gap: Float[np.ndarray, "growth speed sensor"]  # between settled cages in the same current
    # Of the nodes of both cages in the same current, on average, and without the drift of the
    # collars [m]
    distance: Float[np.ndarray, "growth speed"]
    distance_without_drift: Float[np.ndarray, "growth speed"]
    met: tuple[MetGap, ...]  # of the record, by growth

    @property
    def widening(self) -> Float[np.ndarray, "speed sensor"]:
        """Gap of the whole growth less that of a net just cleaned."""
        return self.gap[-1] - self.gap[0]


def fouling_gap(
    windows: Windows,  # with the low fidelity's answers
    hidden: TruthParameters,  # how the truth differs; the field was made with it
    stages: Stages,
    *,
    begin: np.datetime64,  # of the record, from which growth is counted
) -> FoulingGap:
    """Settle both cages in the same currents at several growths, and sort the record by growth."""
    sensors = windows.sensors
    to = sensors.cage.site.current_to
    plan = Plan.grid(current_speed=SPEEDS, current_to=(to,), name="fouling")
    quiet = replace(stages, progress=no_progress)  # progress is of the growths
    low = quiet.ensure_campaign("fouling", sensors.cage, plan)
    true = [
        quiet.ensure_campaign(
            "fouling", hidden.true_cage(sensors.cage, growth), plan, law=hidden.law
        )
        for growth in count(GROWTHS, "fouling", stages.progress)
    ]
    of_low, *responses = (
        sensors.responses_of(one.node_position, one.bridle_tension) for one in (low, *true)
    )
    apart = [one.node_position - low.node_position for one in true]
    collar = sensors.cage.ring_nodes(0)
    growth = hidden.fouling.grown((windows.end - begin) / _DAY)
    return FoulingGap(
        sensors=sensors.names,
        units=sensors.units,
        current_to=to,
        growth=np.array(GROWTHS),
        speed=np.array(SPEEDS),
        gap=np.stack(responses) - of_low,
        distance=_mean_distance(apart),
        distance_without_drift=_mean_distance([without_drift(one, collar) for one in apart]),
        met=_gaps_by_growth(windows, growth),
    )


def _mean_distance(
    apart: list[Float[np.ndarray, "case node 3"]],
) -> Float[np.ndarray, "growth case"]:
    return np.linalg.norm(np.stack(apart), axis=-1).mean(axis=-1)


def _gaps_by_growth(windows: Windows, growth: Float[np.ndarray, " window"]) -> tuple[MetGap, ...]:
    """Equal shares of the growth that the record has, each with enough windows."""
    edges = np.linspace(growth.min(), growth.max(), _BINS + 1)
    share = np.clip(np.searchsorted(edges, growth, side="right") - 1, 0, _BINS - 1)
    gap = windows.truth - windows.low
    return tuple(
        MetGap(
            growth=float(growth[here].mean()), windows=int(np.sum(here)), gap=gap[here].mean(axis=0)
        )
        for here in (share == number for number in range(_BINS))
        if np.sum(here) >= _LEAST
    )
