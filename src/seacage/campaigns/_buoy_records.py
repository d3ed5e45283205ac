"""Buoys' records of currents and waves: made from tides, weather and chance, or a real winter's."""

import math
from datetime import datetime

import numpy as np
from jaxtyping import Bool, Float, Shaped

from seacage.conventions import GRAVITY, InputError, Origin, compass, towards
from seacage.ocean import steepness_limit
from seacage.records import Record, check_record, instant

AnyPerRow = Shaped[np.ndarray, " row"]
_HOUR = 3600.0
# Period [h], and half-axes of the current's ellipse along and across the stream [m/s]
_TIDES = {"M2": (12.4206012, 0.62, 0.08), "S2": (12.0, 0.20, 0.03), "K1": (23.9344696, 0.14, 0.03)}

# Where the flood goes, clockwise from north: along the long axis of the ellipses [deg]
_STREAM_TO = 20.0

_DRIFT = 0.10  # mean current along the stream [m/s]

_KEYS = ("hs_m", "tp_s", "wave_from_deg")
_HEIGHT = (0.5, 0.58, 3.0)  # median of Hs [m], spread of its logarithm, and the most [m]
# Tp / (5 sqrt(Hs)): its least, the median above that, and the spread of that one's logarithm. Near
# what the hindcast NORA10 has off Norway: median 1.16, 5 to 95 % from 0.84 to 2.16.
_PERIOD = (0.75, 0.41, 0.75)

_SWELL = -0.6  # correlation of height and relative period: a low sea is mostly swell
_MEMORY = 40.0 * _HOUR  # of the weather [s]
_FROM = 250.0  # where the weather comes from on average, clockwise from north [deg]
_LONGEST_GAP = 12.0 * _HOUR  # in a winter that has it all [s]


def wandering(
    rng: np.random.Generator, steps: int, *, sd: float, step_s: float, memory_s: float
) -> Float[np.ndarray, "step 2"]:
    """A stationary Ornstein–Uhlenbeck vector, sampled exactly.

    ``rng``: source of chance. ``steps``: how many samples. ``sd``: of each component [any unit,
    kept]. ``step_s``, ``memory_s``: time between samples, and in which the correlation falls to 1/e
    [s].

    Source: Uhlenbeck and Ornstein (1930); its samples are an AR(1) series.
    """
    from scipy.signal import lfilter

    kept = np.exp(-step_s / memory_s)
    shocks = rng.normal(scale=sd * np.sqrt(1.0 - kept**2), size=(steps, 2))
    shocks[0] = rng.normal(scale=sd, size=2)
    return np.asarray(lfilter([1.0], [1.0, -kept], shocks, axis=0))


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
    velocity = stream + weather + turbulence
    speed = np.linalg.norm(velocity, axis=1) + rng.normal(scale=0.015, size=steps)
    direction = compass(velocity) + rng.normal(scale=3.0, size=steps)
    values = {
        "current_speed_m_s": np.round(np.maximum(speed, 0.0), 3),
        "current_to_deg": np.round(direction) % 360.0,
    }
    note = f"A generated current: tide, weather and noise from seed {seed}."
    return _buoy_record(start, time, values, note)


def _tide(rng: np.random.Generator, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 2"]:
    """Velocity along and to the right of the stream [m/s]."""
    velocity = np.zeros((len(time), 2))
    for period, along, across in _TIDES.values():
        phase = 2.0 * np.pi * (time / (period * _HOUR) + rng.uniform())
        velocity += np.column_stack([along * np.cos(phase), across * np.sin(phase)])
    return velocity


def generated_waves(seed: int, *, start: datetime, days: float = 50.0) -> Record:
    """A wave record of a sheltered site, with weather that passes over days.

    Hs is log-normal about 0.5 m and 3 m at most; Tp is that of 5 sqrt(Hs) times a factor that
    is log-normal above 0.75, larger in low seas; the direction wanders about west-southwest.
    It is no place's climate: origin "virtual field".

    ``seed``: of the weather.
    ``start``: time of the first value, with its zone.
    ``days``: length of the record, of a value an hour.
    """
    steps = int(days * 24.0)
    if steps < 1:
        raise InputError(f"generated_waves: {days:g} days hold no step of an hour.")
    rng = np.random.default_rng([seed, *b"waves"])
    high, own = wandering(rng, steps, sd=1.0, step_s=_HOUR, memory_s=_MEMORY).T
    wind = wandering(rng, steps, sd=0.6, step_s=_HOUR, memory_s=_MEMORY)
    middle, spread, most = _HEIGHT
    hs = np.minimum(middle * np.exp(spread * high), most)
    least, above, width = _PERIOD
    long = _SWELL * high + math.sqrt(1.0 - _SWELL**2) * own
    tp = 5.0 * np.sqrt(hs) * (least + above * np.exp(width * long))
    values = {
        "hs_m": np.round(hs, 2),
        "tp_s": np.round(tp, 1),
        "wave_from_deg": np.round(compass(wind + towards(np.array(1.0), np.array(_FROM)))),
    }
    note = f"Generated waves: weather from seed {seed}."
    return _buoy_record(start, np.arange(steps) * _HOUR, values, note)


def _buoy_record(
    start: datetime, seconds: AnyPerRow, values: dict[str, np.ndarray], note: str
) -> Record:
    """A generated record, checked as any."""
    time, origin = instant(start) + (seconds * 1e6).astype("timedelta64[us]"), Origin.VIRTUAL_FIELD
    record = Record(stream="buoy-1", time=time, values=values, origin=origin, notes=(note,))
    return check_record(record)


def waves_at_site(
    record: Record, buoy_time: Shaped[np.ndarray, " t"], *, factor: float, most: float
) -> Record:
    """Bring a winter's waves to the dates of a buoy, and to a sheltered site.

    The same days of the first year that has them all, lower by a factor; a sea that would then
    be too steep to stand has its period lengthened. The notes say what was done.

    Parameters
    ----------
    record
        Of waves: height, period and direction.
    buoy_time
        Of the buoy's record, UTC.
    factor
        Heights at the site over those of the record [-].
    most
        Highest Hs at the site [m].

    Raises InputError: a record without waves, or one that has those days in no year.
    """
    kept = _usable(record)
    time = record.time[kept]
    shift, rows = _same_days(time, buoy_time[0], buoy_time[-1], stream=record.stream)
    values = {key: record.values[key][kept][rows] for key in _KEYS}
    hs = np.minimum(values["hs_m"] * factor, most)
    tp = np.maximum(values["tp_s"], shortest_period(hs))
    begun = time[rows.start].astype("datetime64[m]")
    lengthened = np.mean(tp > values["tp_s"])
    note = (
        f"Waves of {record.stream} ({record.origin}) from {begun}Z on, moved by "
        f"{shift / np.timedelta64(1, 'D'):g} days; heights times {factor:g}, {most:g} m at "
        f"most; periods lengthened at {lengthened:.0%} of the times, where too steep."
    )
    return Record(
        stream=record.stream,
        time=time[rows] + shift,
        values={**values, "hs_m": hs, "tp_s": tp},
        flags={key: record.flags[key][kept][rows] for key in _KEYS},
        origin=Origin.VIRTUAL_FIELD,
        notes=(note,),
    )


def shortest_period(hs: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """Peak period of the steepest sea that stands, by its height [s]."""
    period = np.arange(0.0, 40.0, 0.05)
    limit = np.array([steepness_limit(each) for each in period])
    steepest = np.sqrt(limit * GRAVITY / (2.0 * math.pi)) * period
    # a thousandth longer, as the chords between the points are below the curve
    return 1.001 * np.interp(np.sqrt(hs), steepest, period)


def usable_waves(record: Record) -> tuple[AnyPerRow, Float[np.ndarray, "row 3"]]:
    """Times of the rows whose waves may be used, with hs [m], tp [s] and wave_from [deg].

    Raises InputError: a record that has no waves, or fewer than two that may be used.
    """
    kept = _usable(record)
    if np.sum(kept) < 2:
        raise InputError(
            f"{record.stream}: {np.sum(kept)} usable waves in {len(record)} rows. "
            "A virtual field needs two at least; leave the waves out for a calm sea."
        )
    return record.time[kept], np.column_stack([record.values[key][kept] for key in _KEYS])


def seconds_of(time: AnyPerRow, since: np.datetime64) -> Float[np.ndarray, " row"]:
    """Seconds from a time to some others."""
    return (time - since) / np.timedelta64(1, "s")


def span_of(time: AnyPerRow) -> float:
    """From the first of some times to the last [s]."""
    return float((time[-1] - time[0]) / np.timedelta64(1, "s")) if len(time) else 0.0


def _usable(record: Record) -> Bool[np.ndarray, " row"]:
    missing = [key for key in _KEYS if key not in record.values]
    if missing:
        raise InputError(
            f"{record.stream}: a record of waves has {', '.join(_KEYS)}; "
            f"{', '.join(missing)} is missing. Give a record that has them all."
        )
    return np.logical_and.reduce([record.usable(key) for key in _KEYS])


def _same_days(
    time: AnyPerRow, start: np.datetime64, end: np.datetime64, *, stream: str
) -> tuple[np.timedelta64, slice]:
    """Shift from the first year whose same days have no long gap to those wanted, and its rows."""
    new_year = start.astype("datetime64[Y]")
    years = np.unique(time.astype("datetime64[Y]"))
    for year in years:
        shift = new_year.astype(start.dtype) - year.astype(start.dtype)
        first = int(np.searchsorted(time, start - shift, side="right")) - 1
        last = int(np.searchsorted(time, end - shift))
        gaps = np.diff(time[max(first, 0) : last + 1]) / np.timedelta64(1, "s")
        if first >= 0 and last < len(time) and gaps.max(initial=0.0) <= _LONGEST_GAP:
            return shift, slice(first, last + 1)
    raise InputError(
        f"{stream}: in none of {len(years)} years has it the waves from {start}Z to {end}Z, day "
        f"by day without a gap over {_LONGEST_GAP / _HOUR:g} h. Give a longer record of waves."
    )
