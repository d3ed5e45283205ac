"""The true cage's shapes beside what a buoy reported: what a twin's shape answers miss."""

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns._buoy_records import generated_current, seconds_of
from seacage.campaigns._cases import CaseBlock, answer_block, software_version
from seacage.campaigns._pool import map_tasks
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.campaigns._virtual_field._weather import current_at_cage
from seacage.conventions import InputError, Progress, Result, compass, no_progress, towards
from seacage.ocean import SeaState

_START = datetime(2020, 1, 18, tzinfo=UTC)  # of the records; no tide here knows the year
_DAYS = 50.0
_EVERY_S = 60.0
# Growth is rounded to this, so that many cases share a cage and settle together [-]
_GROWTH_STEP = 0.25


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrueShapes:
    """Shapes of a virtual field's cage, and the currents that its buoy reported meanwhile."""

    current_velocity: Float[np.ndarray, "case 2"]  # as reported, (east, north) [m/s]
    node_position: Float[np.ndarray, "case node 3"]  # as they truly were [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Moments:
    """Times at which a virtual field is looked at, and the cage drawn by its seed."""

    hidden: TruthParameters
    reported: Float[np.ndarray, "case 2"]
    velocity: Float[np.ndarray, "case 2"]
    growth: Float[np.ndarray, " case"]


def true_shapes(
    cage: Cage,
    *,
    hidden: TruthParameters,
    seeds: Sequence[int],
    cases: int,
    workers: int | None = None,
    progress: Progress | None = None,
) -> TrueShapes:
    """Settle the true cage at times of several generated records.

    Each seed draws a record, turned to a direction of its own, the buoy's errors and the eddies
    that it does not see, and the cage from its ranges. The times are spread evenly over the speeds,
    for a record's own are mostly slow. Left out, as in every settled field: waves, the current's
    profile, and that a cage takes time to follow. Growth is rounded to a quarter of the whole.

    Parameters
    ----------
    cage, hidden, workers
        As for ``virtual_field``.
    seeds
        One record each.
    cases
        Times of each record.
    progress
        Called as ("shape error", done, total) in cases.
    """
    if cases < 1 or not seeds:
        raise InputError(f"true_shapes: {len(seeds)} seeds of {cases} cases hold none. Ask for 1.")
    moments = [_moments(hidden, seed, cases) for seed in seeds]
    reported = np.concatenate([one.reported for one in moments])
    position = np.full((len(reported), cage.node_count, 3), np.nan)
    report, done = progress or no_progress, 0
    blocks = _blocks(cage, moments)
    running = map_tasks(answer_block, list(blocks), workers=workers)
    with closing(running) as finished:
        for block, answers in finished:
            rows = blocks[block]
            kept = answers.values["result"] != Result.DIVERGED
            position[rows[kept]] = answers.values["node_position"][kept]
            done += len(rows)
            report("shape error", done, len(reported))
    whole = np.isfinite(position).all(axis=(1, 2))
    return TrueShapes(current_velocity=reported[whole], node_position=position[whole])


def _moments(hidden: TruthParameters, seed: int, cases: int) -> _Moments:
    # The word keeps these draws apart from those of a field that has the same seed.
    weather, choice, turn = np.random.default_rng([seed, *b"shapes"]).spawn(3)
    built = hidden.drawn(int(turn.integers(2**31)))
    buoy = generated_current(seed, start=_START, days=_DAYS)
    turned = (buoy.values["current_to_deg"] + turn.uniform(0.0, 360.0)) % 360.0
    buoy = replace(buoy, values={**buoy.values, "current_to_deg": turned})
    at = seconds_of(buoy.time, buoy.time[0])
    seconds = np.arange(0.0, at[-1] + _EVERY_S, _EVERY_S)
    current = current_at_cage(buoy, seconds, hidden=built, rng=weather)
    speed = buoy.values["current_speed_m_s"]
    wanted = choice.uniform(0.0, speed.max(), cases)
    # Of the ten rows nearest to a speed any one, lest the fastest hour be all there is.
    nearest = np.argsort(np.abs(speed - wanted[:, None]), axis=1)[:, :10]
    rows = choice.permuted(nearest, axis=1)[:, 0]
    grown = hidden.fouling.grown(at[rows] / 86400.0)
    return _Moments(
        hidden=built,
        reported=towards(speed[rows], buoy.values["current_to_deg"][rows]),
        velocity=current[np.searchsorted(seconds, at[rows])],
        growth=np.rint(grown / _GROWTH_STEP) * _GROWTH_STEP,
    )


def _blocks(cage: Cage, moments: Sequence[_Moments]) -> dict[CaseBlock, np.ndarray]:
    """Cases that share a cage, a campaign's block at a time, and their rows."""
    by, blocks, before = moments[0].hidden.equilibria, {}, 0
    for one in moments:
        for growth in np.unique(one.growth):
            toml = one.hidden.true_cage(cage, float(growth)).to_toml()
            rows = np.flatnonzero(one.growth == growth)
            for part in np.split(rows, range(by.block, len(rows), by.block)):
                block = CaseBlock(
                    first=before + int(part[0]),
                    cage_toml=toml,
                    seas=tuple(_sea(velocity) for velocity in one.velocity[part]),
                    wave_seeds=(0,) * len(part),
                    duration=0.0,
                    simulator=by,
                    made_by=software_version(by.law),
                )
                blocks[block] = before + part
        before += len(one.growth)
    return blocks


def _sea(velocity: Float[np.ndarray, " 2"]) -> SeaState:
    return SeaState(current_speed=float(np.hypot(*velocity)), current_to=float(compass(velocity)))
