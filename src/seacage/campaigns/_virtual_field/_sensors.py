"""Virtual sensors and the radio: the truth as imperfect instruments report it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float, Shaped

from seacage.campaigns._buoy_records import seconds_of, wandering
from seacage.campaigns._virtual_field._events import Event
from seacage.campaigns._virtual_field._spells import Spells
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.records import Record, check_record

_WEEK = 604800.0
_WEATHER_STEP = 600.0  # within which the air pressure hardly changes
Times = Shaped[np.ndarray, " t"]
Values = Float[np.ndarray, " t"]


def radio_silence(hidden: TruthParameters, time: Times, rng: np.random.Generator) -> Spells:
    """Spells in which no stream is received, between the first and the last of some times."""
    own = hidden.outages
    often, long = own.radio_losses_per_week, own.radio_loss_mean_h
    return Spells.by_chance(time, rng, per_week=often, mean_h=long)


def air_pressure(hidden: TruthParameters, time: Times, rng: np.random.Generator) -> Values:
    """How far the air's pressure is off its mean at some times, for all sensors alike [hPa]."""
    errors, seconds = hidden.depth, seconds_of(time, time[0])
    grid = np.arange(0.0, seconds[-1] + 2.0 * _WEATHER_STEP, _WEATHER_STEP)
    sd, memory = errors.air_pressure_sd_hpa, errors.air_pressure_memory_s
    weather = wandering(rng, len(grid), sd=sd, step_s=_WEATHER_STEP, memory_s=memory)
    return np.interp(seconds, grid, weather[:, 0])


def sense(
    truth: Record,
    hidden: TruthParameters,
    rng: np.random.Generator,
    *,
    wave_head: Values | None = None,
    pressure: Values | None = None,
    silence: Spells | None = None,
    events: Sequence[Event] = (),
) -> Record:
    """Record of a sensor made from the truth, quality flags included.

    A shackle has a gain, a bias and noise, and lives in its windows. A depth sensor takes
    waves and weather for depth, has noise and drifts. Both get stuck, spike, lose single
    readings and fall silent; when, does not hang on the step between readings.

    ``truth``: one error-free sensor; a depth is that below still water. ``hidden``: sizes of the
    errors. ``rng``: source of chance, this sensor's own. ``wave_head``: what the waves add to a
    depth sensor's pressure, as a depth [m]; None without waves. ``pressure``: of the air, off its
    mean [hPa]; None for an even one. ``air_pressure`` makes it. ``silence``: when the radio is
    dead; None where it never is. ``radio_silence`` makes it. ``events``: those that meet this
    sensor; others change nothing.
    """
    ((key, exact),) = truth.values.items()
    noise, faults = rng.spawn(2)
    if key == "tension_kn":
        cell = hidden.shackle
        gain = 1.0 + cell.gain * noise.uniform(-1.0, 1.0)
        bias = cell.bias_kn * noise.uniform(-1.0, 1.0)
        values = gain * exact + bias + noise.normal(scale=cell.noise_sd_kn, size=len(exact))
        size, alive = cell.spike_kn, Spells.at_shares(truth.time, cell.windows)
    else:
        errors, seconds = hidden.depth, seconds_of(truth.time, truth.time[0])
        drift = noise.choice([-1.0, 1.0]) * errors.drift_m_week * seconds / _WEEK
        values = exact + drift + noise.normal(scale=errors.noise_sd_m, size=len(exact))
        values += 0.0 if wave_head is None else wave_head
        values += 0.0 if pressure is None else errors.m_per_hpa * pressure
        size, alive = errors.spike_m, None
    sent = replace(truth, values={key: values}, flags={})
    return _receive(sent, events, {key: size}, hidden, faults, silence=silence, alive=alive)


def receive_buoy(
    buoy: Record,
    hidden: TruthParameters,
    rng: np.random.Generator,
    *,
    silence: Spells | None = None,
    events: Sequence[Event] = (),
) -> Record:
    """A buoy's record as it is received, with the faults of its way.

    It gets stuck, its speed spikes, single readings are lost, and it falls silent. It adds no
    noise: the buoy's own is in its record.

    ``buoy``: what it measured. ``hidden``, ``rng``, ``silence``, ``events``: as of ``sense``.
    """
    sizes = {"current_speed_m_s": hidden.buoy.spike_m_s}
    return _receive(replace(buoy, flags={}), events, sizes, hidden, rng, silence=silence)


def _receive(
    sent: Record,
    events: Sequence[Event],
    spike_sizes: Mapping[str, float],
    hidden: TruthParameters,
    rng: np.random.Generator,
    *,
    silence: Spells | None,
    alive: Spells | None = None,
) -> Record:
    """Record of a stream as it arrives, with its quality flags.

    Spells are drawn over all its times, not those that an event left, so that an event that
    silences it moves no other fault.
    """
    all_times, outages, (sticking, spiking, losing) = sent.time, hidden.outages, rng.spawn(3)
    for event in events:
        sent = event.apply_to(sent)
    time, values = sent.time, {key: column.copy() for key, column in sent.values.items()}
    stuck = Spells.by_chance(
        all_times, sticking, per_week=outages.stuck_per_week, mean_h=outages.stuck_mean_h
    )
    for rows in stuck.rows(time):
        for column in values.values():
            column[rows] = column[rows.start]
    spikes = Spells.by_chance(all_times, spiking, per_week=outages.spikes_per_week)
    for key, size in spike_sizes.items():
        # Single readings are set far off.
        rows = np.searchsorted(time, spikes.start)
        far = size * spiking.choice([-1.0, 1.0], len(rows)) * spiking.uniform(0.7, 1.3, len(rows))
        there = rows < len(time)
        values[key][rows[there]] += far[there]
    gaps = Spells.by_chance(
        all_times, losing, per_week=outages.gaps_per_week, mean_h=outages.gap_mean_h
    )
    received = (losing.uniform(size=len(time)) >= outages.lost_share) & ~gaps.cover(time)
    if silence is not None:
        received &= ~silence.cover(time)
    if alive is not None:
        received &= alive.cover(time)
    values = {key: column[received] for key, column in values.items()}
    return check_record(replace(sent, time=time[received], values=values, flags={}))
