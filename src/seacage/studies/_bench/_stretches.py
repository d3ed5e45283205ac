"""Stretches of weeks, each in weather of its own, in most of which one sensor breaks."""

from dataclasses import replace
from datetime import datetime
from typing import Any

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, generated_current, virtual_field
from seacage.records import Record

DAY = np.timedelta64(1, "D")
BLOCK_S, BLOCKS = 1800.0, 48  # of each reading, and of a day
WATCH_DAYS = 21
BEFORE = DAY // 2  # of a stretch, from which on the current is known
# What breaks, and how the names of the sensors begin that it may befall: a depth drifts by 0.1 m a
# day, a reading is off by 1 m or 10 kN, a shackle reads nothing
FAULTS = {"drift": "depth", "offset": "", "nothing": "shackle"}
CURRENT = ("current_speed_m_s", "current_to_deg")
DRIFT_M_DAY, OFFSET_M, OFFSET_KN = 0.1, 1.0, 10.0


def make_stretches(
    cage: Cage,
    current: Record | None,  # at the buoy in all stretches; None generates each its own
    *,
    hidden: TruthParameters,
    start: datetime,
    after_days: int,  # days of training, behind which a stretch begins
    count: int,
    seed: int,
    **how: Any,
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """What is read in each stretch [kN] or [m], and what is not known of it: the faults."""
    rng = np.random.default_rng([seed, *b"faults"])
    kinds = [list(FAULTS)[row % 3] if row < 2 * count // 3 else "" for row in range(count)]
    rng.shuffle(kinds)
    seen = dict[str, list[np.ndarray]]()
    faults = {
        "fault_kind": np.array(kinds),
        "fault_sensor": np.full(count, -1),
        "fault_block": np.zeros(count, dtype=int),
    }
    hidden, days = without_outages(hidden), float(after_days + WATCH_DAYS + 1)
    for row, kind in enumerate(kinds):
        own = 1000 * seed + row + 1
        buoy = generated_current(own, start=start, days=days) if current is None else current
        field = virtual_field(
            cage, buoy, hidden=hidden, seed=own, method="settle", every_s=BLOCK_S, **how
        ).record
        begin = buoy.time[0] + after_days * DAY
        sensors = list(field.sensors.values())
        whole = min(int((sensors[0].time[-1] - begin) / DAY), WATCH_DAYS)
        rows = np.searchsorted(sensors[0].time, begin) + np.arange(whole * BLOCKS)
        reading = np.column_stack([next(iter(one.values.values()))[rows] for one in sensors])
        if kind:
            able = [k for k, one in enumerate(sensors) if one.stream.startswith(FAULTS[kind])]
            sensor, block = rng.choice(able), rng.integers(len(rows) // 3, len(rows) // 2)
            faults["fault_sensor"][row], faults["fault_block"][row] = sensor, block
            _break(reading[block:, sensor], kind, sensors[sensor])
        ends = np.searchsorted(buoy.time, [begin - BEFORE, sensors[0].time[rows[-1]]])
        known = buoy.rows(slice(*ends))
        entries = {
            "stretch_time": sensors[0].time[rows],
            "stretch_reading": reading,
            "stretch_buoy_time": known.time,
            **{f"stretch_{key}": known.values[key] for key in CURRENT},
        }
        for name, value in entries.items():
            seen.setdefault(name, []).append(value)
    return {name: np.stack(each) for name, each in seen.items()}, faults


def _break(reading: Float[np.ndarray, " t"], kind: str, sensor: Record) -> None:
    """Change readings in place, from the fault's first on."""
    if kind == "nothing":
        reading[:] = 0.0
    elif kind == "drift":
        reading += DRIFT_M_DAY * np.arange(len(reading)) / BLOCKS
    else:
        reading += OFFSET_M if "depth_m" in sensor.values else OFFSET_KN


def without_outages(hidden: TruthParameters) -> TruthParameters:
    """The same truth, whose sensors have noise, gains and biases alone, and always live."""
    none = dict.fromkeys(("lost_share", "gaps_per_week", "spikes_per_week"), 0.0)
    none |= dict.fromkeys(("stuck_per_week", "radio_losses_per_week"), 0.0)
    return replace(
        hidden,
        shackle=replace(hidden.shackle, windows=((0.0, 1e9),)),
        depth=replace(hidden.depth, drift_m_week=0.0),
        outages=replace(hidden.outages, **none),
    )
