"""A current record made from tides, weather and noise, for when there is no real one."""

from datetime import datetime

import numpy as np
from jaxtyping import Float

from seacage.campaigns._noise import wandering
from seacage.conventions import InputError, Origin, compass, towards
from seacage.records import Record, check_record, instant

_HOUR = 3600.0

# Period [h], and half-axes of the current's ellipse along and across the stream [m/s]
_TIDES = {"M2": (12.4206012, 0.62, 0.08), "S2": (12.0, 0.20, 0.03), "K1": (23.9344696, 0.14, 0.03)}

# Where the flood goes, clockwise from north: along the long axis of the ellipses [deg]
_STREAM_TO = 20.0

_DRIFT = 0.10  # mean current along the stream [m/s]


def generated_current(
    seed: int, *, start: datetime, days: float = 50.0, every_s: float = 720.0
) -> Record:
    """A buoy's current record with tides, weather and turbulence, as a buoy would report it.

    The tides are ellipses of M2, S2 and K1 with phases drawn from the seed, so springs
    follow neaps; the weather wanders over days, the turbulence over minutes. The buoy adds
    its own error (0.015 m/s, 3 degrees) and rounds to 0.1 cm/s and 1 degree. With the
    default sizes the mean speed is near 0.45 m/s and a few values pass 1 m/s. It is no
    place's climate: origin "virtual field".

    Parameters
    ----------
    seed
        Of phases, weather and noise.
    start
        Time of the first value, with its zone.
    days
        Length of the record.
    every_s
        Time between values [s].

    Source: periods of the constituents: Doodson (1921).
    """
    steps = int(days * 24.0 * _HOUR / every_s)
    if steps < 1:
        raise InputError(f"generated_current: {days:g} days hold no step of {every_s:g} s.")
    rng = np.random.default_rng(seed)
    time = np.arange(steps) * every_s
    along, across = (_tide(rng, time) + np.array([_DRIFT, 0.0])).T
    to = np.full(steps, _STREAM_TO)
    stream = towards(along, to) + towards(across, to + 90.0)
    weather = wandering(rng, steps, sd=0.09, step_s=every_s, memory_s=36.0 * _HOUR)
    turbulence = wandering(rng, steps, sd=0.03, step_s=every_s, memory_s=0.5 * _HOUR)
    record = Record(
        stream="buoy-1",
        time=instant(start) + (time * 1e6).astype("timedelta64[us]"),
        values=_report(rng, stream + weather + turbulence),
        origin=Origin.VIRTUAL_FIELD,
        notes=(f"A generated current: tide, weather and noise from seed {seed}.",),
    )
    return check_record(record)


def _tide(rng: np.random.Generator, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 2"]:
    """Velocity along and to the right of the stream [m/s]."""
    velocity = np.zeros((len(time), 2))
    for period, along, across in _TIDES.values():
        phase = 2.0 * np.pi * (time / (period * _HOUR) + rng.uniform())
        velocity += np.column_stack([along * np.cos(phase), across * np.sin(phase)])
    return velocity


def _report(
    rng: np.random.Generator, velocity: Float[np.ndarray, "t 2"]
) -> dict[str, Float[np.ndarray, " t"]]:
    speed = np.linalg.norm(velocity, axis=1) + rng.normal(scale=0.015, size=len(velocity))
    direction = compass(velocity) + rng.normal(scale=3.0, size=len(velocity))
    return {
        "current_speed_m_s": np.round(np.maximum(speed, 0.0), 3),
        "current_to_deg": np.round(direction) % 360.0,
    }
