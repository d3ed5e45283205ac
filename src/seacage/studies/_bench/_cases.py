"""Cases of the benchmark: what a learner may see, in one folder, and the truth, in a file beside.

A case is a hidden cage of the family in one water. Nothing in ``given`` comes from the truth but
through sensors with their errors.
"""

from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, generated_current, true_nets, virtual_field
from seacage.conventions import InputError
from seacage.records import FieldRecord, Record
from seacage.studies._bench._peaks import sea_field
from seacage.studies._bench._stretches import CURRENT, make_stretches

START = datetime(2020, 1, 18, tzinfo=UTC)  # of a generated current
HALF_HOUR, DAY = np.timedelta64(30, "m"), np.timedelta64(1, "D")
LEAST_DAYS = 8.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Size:
    """How much of everything a benchmark takes."""

    cage: Cage
    # Settled cases that level 1 learns from, and half-hours in waves
    cases: int = 400
    wave_cases: int = 200
    days: float = 50.0  # of a generated record, whose first half trains
    nets: int = 100  # times at which the whole net is scored
    stretches: int = 24  # watched for faults, two of three with one
    seas: int = 64  # half-hours in waves, the first half of which trains

    @property
    def settings(self) -> dict[str, object]:
        """All of it as JSON takes it."""
        return {**asdict(self), "cage": self.cage.to_toml()}


@dataclass(frozen=True, kw_only=True)
class Given:
    """What a learner may see of a case."""

    folder: Path
    cage: Cage

    @cached_property
    def field(self) -> FieldRecord:
        """Buoy of all days, and the sensors of the training days."""
        return FieldRecord.read(self.folder / "field")

    @cached_property
    def waves(self) -> FieldRecord:
        """Buoy and shackles in the seas that train."""
        return FieldRecord.read(self.folder / "waves")

    @cached_property
    def queries(self) -> dict[str, np.ndarray]:
        """Times and seas to answer for, and the stretches to watch."""
        return dict(np.load(self.folder / "queries.npz", allow_pickle=False))

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Shapes of the arrays that a file of predictions may hold, by their names."""
        found, shackles = self.queries, len(self.cage.shackles)
        loads = len(found["time"]), shackles
        return {
            "mean_kn": loads,
            "sd_kn": loads,
            "node_m": (len(found["net_time"]), self.cage.node_count, 3),
            "raised": (*found["stretch_time"].shape, len(self.cage.sensor_names) + 1),
            "peak_kn": (len(found["sea_hs_m"]), shackles),
        }


def make_case(
    begun: Path,
    size: Size,
    hidden: TruthParameters,
    *,
    current: Record | None,  # at the buoy; None for one that is generated
    seed: int,
    kept: Path,  # folder of the settled cages
    workers: int | None,
) -> None:
    """Make a case into a folder: ``given``, and the truth in ``sealed.npz``."""
    cage, given = size.cage, begun / "given"
    buoy = generated_current(seed, start=START, days=size.days) if current is None else current
    training_days = check_days(buoy)
    how: dict[str, Any] = {"hidden": hidden, "kept": kept, "workers": workers}
    field = virtual_field(cage, buoy, seed=seed, method="settle", **how)
    cut = buoy.time[0] + training_days * DAY
    seen = {
        name: one.rows(slice(0, int(np.searchsorted(one.time, cut))))
        for name, one in field.record.sensors.items()
    }
    replace(field.record, sensors=seen).write(given / "field")
    last = next(iter(field.truth.sensors.values())).time[-1]
    time = np.arange(cut, last, HALF_HOUR)
    known = buoy.usable(CURRENT[0]) & buoy.usable(CURRENT[1])
    time = time[known[np.searchsorted(buoy.time, time, side="right") - 1]]
    net_time = time[np.linspace(0, len(time) - 1, size.nets).astype(int)]
    stretches, faults = make_stretches(
        cage, current, start=START, after_days=training_days, count=size.stretches, seed=seed, **how
    )
    chance = np.random.default_rng([seed, *hidden.sha256.encode()])
    waves, seas, peak = sea_field(cage, hidden, START, count=size.seas, chance=chance)
    waves.write(given / "waves")
    queries = {"time": time, "net_time": net_time, **stretches, **seas}
    np.savez_compressed(given / "queries.npz", allow_pickle=False, **queries)
    np.savez_compressed(
        begun / "sealed.npz",
        allow_pickle=False,
        tension_kn=np.column_stack(
            [values_at(field.truth.sensors[one.name], time) / 1e3 for one in cage.shackles]
        ),
        node_m=true_nets(cage, buoy, net_time, seed=seed, **how),
        peak_kn=peak,
        **faults,
    )


def check_days(buoy: Record) -> int:
    """Days of a record that train: half of them.

    Raises InputError: too short a record.
    """
    days = float((buoy.time[-1] - buoy.time[0]) / DAY) if len(buoy) else 0.0
    if days < LEAST_DAYS:
        raise InputError(
            f"study bench: {buoy.stream} spans {days:.1f} days, and half of them train; a "
            f"benchmark needs {LEAST_DAYS:g}. Give a longer record."
        )
    return round(days / 2.0)


def values_at(record: Record, time: np.ndarray) -> np.ndarray:
    """What a sensor of the truth reads at some times [N] or [m]."""
    ((key, values),) = record.values.items()
    at = np.minimum(np.searchsorted(record.time, time), len(record) - 1)
    return values[at] * (1e3 if key == "tension_kn" else 1.0)
