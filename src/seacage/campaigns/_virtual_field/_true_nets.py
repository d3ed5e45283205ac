"""Nets of a settled virtual field, which no sensor sees, from the equilibria of its cage."""

from pathlib import Path

import numpy as np
from jaxtyping import Float, Shaped

from seacage.cage import Cage
from seacage.campaigns._virtual_field._field import current_over_net
from seacage.campaigns._virtual_field._responses import true_responses
from seacage.campaigns._virtual_field._timetable import reading_times
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.records import Record


def true_nets(
    cage: Cage,
    buoy: Record,
    time: Shaped[np.ndarray, " t"],
    *,
    hidden: TruthParameters,
    seed: int,
    kept: str | Path,
    workers: int | None = None,
) -> Float[np.ndarray, "t node 3"]:
    """Positions of the true net's nodes in a settled virtual field [m].

    ``time``: of the field's readings, as it reads every minute. All others: as for
    ``virtual_field``, which has filled ``kept`` with the equilibria that are interpolated here.
    """
    seconds = (reading_times(buoy, None, usual_s=60.0) - buoy.time[0]) / np.timedelta64(1, "s")
    rows = np.searchsorted(seconds, (time - buoy.time[0]) / np.timedelta64(1, "s"))
    velocity = current_over_net(buoy, seconds, hidden=hidden, seed=seed)[rows]
    answers, _ = true_responses(
        cage,
        hidden,
        readings=lambda _, one: one.node_position.reshape(len(one), -1),
        store=Path(kept),
        workers=workers,
    )
    flat = answers.answers_of(velocity, hidden.fouling.grown(seconds[rows] / 86400.0))
    return flat.reshape(len(rows), -1, 3)
