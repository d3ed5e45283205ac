"""Virtual sensors: what is true, as imperfect instruments tell it."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from seacage.campaigns._hidden import Hidden, HiddenDepth, HiddenOutages, HiddenShackle
from seacage.records import Record, check_record

_HOUR, _WEEK = 3600.0, 604800.0

Times = Float[np.ndarray, " t"]


def sensed(truth: Record, hidden: Hidden, rng: np.random.Generator) -> Record:
    """What a sensor made of the truth, quality flags included.

    A shackle has a gain, a bias and noise, and lives in two windows; a depth sensor has
    noise and drifts. Both get stuck, spike, lose single readings and fall silent.

    Parameters
    ----------
    truth
        One error-free sensor, in even steps.
    hidden
        Sizes of the errors.
    rng
        Source of chance, this sensor's own.
    """
    ((key, exact),) = truth.values.items()
    seconds = (truth.time - truth.time[0]) / np.timedelta64(1, "s")
    if key == "tension_kn":
        values = _loaded(exact, hidden.shackle, rng)
        spike, alive = hidden.shackle.spike_kn, _in_windows(seconds, hidden.shackle)
    else:
        values = _sunk(exact, seconds, hidden.depth, rng)
        spike, alive = hidden.depth.spike_m, np.ones(len(exact), bool)
    values = _spiked(_stuck(values, seconds, hidden.outages, rng), seconds, spike, hidden, rng)
    heard = alive & _heard(seconds, hidden.outages, rng)
    return check_record(
        replace(truth, time=truth.time[heard], values={key: values[heard]}, flags={})
    )


def _loaded(exact: Times, errors: HiddenShackle, rng: np.random.Generator) -> Times:
    gain = 1.0 + errors.gain * rng.uniform(-1.0, 1.0)
    bias = errors.bias_kn * rng.uniform(-1.0, 1.0)
    return gain * exact + bias + rng.normal(scale=errors.noise_sd_kn, size=len(exact))


def _in_windows(seconds: Times, errors: HiddenShackle) -> Bool[np.ndarray, " t"]:
    alive = np.zeros(len(seconds), bool)
    for share, hours in errors.windows:
        start = share * seconds[-1]
        alive |= (seconds >= start) & (seconds < start + hours * _HOUR)
    return alive


def _sunk(exact: Times, seconds: Times, errors: HiddenDepth, rng: np.random.Generator) -> Times:
    drift = rng.choice([-1.0, 1.0]) * errors.drift_m_week * seconds / _WEEK
    return exact + drift + rng.normal(scale=errors.noise_sd_m, size=len(exact))


def _stuck(
    values: Times, seconds: Times, outages: HiddenOutages, rng: np.random.Generator
) -> Times:
    """Now and then a sensor repeats its last value for a while."""
    held = values.copy()
    for span in _spans(seconds, outages.stuck_per_week, outages.stuck_mean_h, rng):
        held[span] = values[span.start]
    return held


def _spiked(
    values: Times, seconds: Times, size: float, hidden: Hidden, rng: np.random.Generator
) -> Times:
    """Single readings are far off."""
    count = rng.poisson(hidden.outages.spikes_per_week * seconds[-1] / _WEEK)
    at = rng.integers(len(values), size=count)
    spiked = values.copy()
    spiked[at] += size * rng.choice([-1.0, 1.0], size=count) * rng.uniform(0.7, 1.3, size=count)
    return spiked


def _heard(
    seconds: Times, outages: HiddenOutages, rng: np.random.Generator
) -> Bool[np.ndarray, " t"]:
    """Readings that arrive: neither lost one by one nor in a gap."""
    heard = rng.uniform(size=len(seconds)) >= outages.lost_share
    for span in _spans(seconds, outages.gaps_per_week, outages.gap_mean_h, rng):
        heard[span] = False
    return heard


def _spans(seconds: Times, per_week: float, mean_h: float, rng: np.random.Generator) -> list[slice]:
    """Spans of rows that begin by chance and last for exponential times."""
    count = rng.poisson(per_week * seconds[-1] / _WEEK)
    starts = rng.uniform(0.0, seconds[-1], size=count)
    ends = starts + rng.exponential(mean_h * _HOUR, size=count)
    rows = np.searchsorted(seconds, [starts, ends])
    return [slice(first, last) for first, last in rows.T if first < len(seconds)]
