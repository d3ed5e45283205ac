"""How far the low fidelity is from the truth: per sensor, direction of the current and growth."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import compass
from seacage.studies._fidelity._windows import Windows
from seacage.studies._interval import Interval, by_day

# Eighths of the compass, each centred on its name
SECTORS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")


@dataclass(frozen=True, slots=True, kw_only=True)
class SectorGap:
    """Low fidelity against the truth while the current goes one way."""

    sector: str  # where the current goes
    windows: int
    # Mean responses [m] or [kN]
    truth: float
    low: float
    mae: float  # mean absolute error of the low fidelity [m] or [kN]

    @property
    def bias(self) -> float:
        """Low fidelity less truth: negative where it underestimates [m] or [kN]."""
        return self.low - self.truth


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorGap:
    """Low fidelity against the truth at one sensor, on 10-minute means."""

    # Its name, and the unit of its response: rise in m, tension in kN
    sensor: str
    unit: str
    windows: int
    # Mean responses
    truth: float
    low: float
    bias: Interval  # low fidelity less truth: negative where it underestimates
    mae: float  # mean absolute error of the low fidelity
    sectors: tuple[SectorGap, ...]  # the same by direction of the current, of those that it had

    @property
    def underestimates(self) -> bool:
        """The low fidelity answers less than the truth on average."""
        return self.bias.mean < 0.0


def sensor_gaps(windows: Windows, *, seed: int) -> tuple[SensorGap, ...]:
    """Compare the low fidelity with the truth at every sensor."""
    sector = sectors(windows)
    return tuple(_gap(windows, column, sector, seed) for column in range(windows.low.shape[1]))


def sectors(windows: Windows) -> Int[np.ndarray, " window"]:
    """Which eighth of the compass the current goes to, as the twin receives it."""
    eighth = 360.0 / len(SECTORS)
    turned = compass(windows.water.current_velocity) + eighth / 2.0
    return (turned // eighth).astype(int) % len(SECTORS)


def _gap(windows: Windows, column: int, sector: Int[np.ndarray, " window"], seed: int) -> SensorGap:
    truth, low = windows.truth[:, column], windows.low[:, column]
    return SensorGap(
        sensor=windows.sensors.names[column],
        unit=windows.sensors.units[column],
        bias=by_day(low - truth, windows.day, seed=seed),
        sectors=tuple(
            SectorGap(sector=name, **_means(truth[here], low[here]))
            for name, here in ((name, sector == number) for number, name in enumerate(SECTORS))
            if np.any(here)
        ),
        **_means(truth, low),
    )


def _means(truth: Float[np.ndarray, " some"], low: Float[np.ndarray, " some"]) -> dict[str, Any]:
    """Numbers of some windows that a sensor and a sector of it both have."""
    mae = float(np.abs(low - truth).mean())
    return {"windows": len(low), "truth": float(truth.mean()), "low": float(low.mean()), "mae": mae}
