"""Fault detection over residuals of half hours: what alarms, and when."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from datetime import datetime

import numpy as np
from jaxtyping import Float, Int, Shaped

from seacage.cage import Cage
from seacage.records import Record
from seacage.twin._alarms._alarm import Action, Alarm
from seacage.twin._alarms._lifecycle import evaluate
from seacage.twin._alarms._policy import AlarmPolicy
from seacage.twin._faults._detector import FaultDetector
from seacage.twin._faults._residuals import ResidualBlock, responses
from seacage.twin._faults._sensor import SensorMonitor
from seacage.twin._settings import FaultDetectorSettings
from seacage.twin._twin import Twin

SETTINGS = FaultDetectorSettings()
POLICY = AlarmPolicy.default()
# Arrays that a block has row by row, as they are
OF_A_BLOCK = {one.name for one in fields(ResidualBlock)} - {"sensors", "received"}


def block_residuals(
    twin: Twin,
    buoy: Record,
    time: Shaped[np.ndarray, " t"],
    reading: Float[np.ndarray, "t sensor"],  # of all sensors of the twin, in its order [N] or [m]
    block: Int[np.ndarray, " t"],  # number of the half hour of each time
) -> dict[str, np.ndarray]:
    """Residuals of half hours, as the fault detector forms them, of the sensors with level 2.

    Half hours without a valid answer inside the training domain are left out.
    """
    names = tuple(name for name in twin.sensor_names if name in twin.models.upper)
    columns = [twin.sensor_names.index(name) for name in names]
    water = twin.travel_time.water_at(buoy, time)
    answer = twin.predict(water).without_nodes()
    known = answer.valid & answer.in_domain
    error = (reading - answer.sensor.mean)[:, columns]
    rows = {int(one): np.flatnonzero((block == one) & known) for one in np.unique(block[known])}
    current = np.array([water.current_velocity[own].mean(axis=0) for own in rows.values()])
    lasts = np.array([one[-1] for one in rows.values()], dtype=int)  # rows whose waves count
    here = replace(water.rows(lasts), current_velocity=current)
    return responses(twin, names, here) | {
        "sensors": np.array(names),
        "number": np.array(list(rows)),
        "residual": np.array([error[inside].mean(axis=0) for inside in rows.values()]),
        "current": current,
    }


def residual_blocks(found: Mapping[str, np.ndarray]) -> Iterator[ResidualBlock]:
    """The same, half hour by half hour, as the fault detector takes them."""
    for row in range(len(found["number"])):
        yield ResidualBlock(
            sensors=tuple(found["sensors"].tolist()),
            received=np.ones(len(found["sensors"]), dtype=bool),
            **{name: found[name][row] for name in OF_A_BLOCK},
        )


@dataclass
class FaultWatch:
    """The fault detector and its alarms, half hour by half hour."""

    cage: Cage
    detector: FaultDetector
    alarms: dict[str, Alarm]

    @classmethod
    def over(cls, cage: Cage, sensors: list[str]) -> "FaultWatch":
        """One that has seen nothing yet."""
        return cls(cage, FaultDetector(monitors={name: SensorMonitor() for name in sensors}), {})

    def see(self, time: datetime, block: ResidualBlock) -> Iterator[str]:
        """Take a half hour in, and name the alarms that are raised."""
        active = frozenset(name for name, alarm in self.alarms.items() if alarm.active)
        self.detector = self.detector.updated(block, self.cage, SETTINGS, active=active)
        most = max((value for _, value in self.detector.ranking()), default=0.0)
        if not active and most < SETTINGS.limit:
            return  # nothing is raised, and nothing waits to be cleared
        for one in self.detector.inputs(self.cage, SETTINGS):
            alarm = self.alarms.get(one.alarm, Alarm(name=one.alarm))
            alarm, lines = evaluate(alarm, one.value, POLICY.limit(one.alarm), time)
            self.alarms[one.alarm] = alarm
            yield from (line.alarm for line in lines if line.action is Action.RAISED)

    def copied(self) -> "FaultWatch":
        """Another that goes its own way from here."""
        return replace(self, alarms=dict(self.alarms))
