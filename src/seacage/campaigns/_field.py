"""A virtual field: a truth that the low fidelity misses, seen by imperfect sensors."""

import tempfile
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float, Shaped

from seacage.cage import Cage
from seacage.campaigns._hidden import Hidden, HiddenCurrent
from seacage.campaigns._noise import wandering
from seacage.campaigns._responses import true_responses
from seacage.campaigns._sensors import sensed
from seacage.conventions import InputError, Origin, Progress, compass, towards
from seacage.records import FieldRecord, Record

_DAY = 86400.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VirtualField:
    """What the virtual sensors said, and what was true.

    Parameters
    ----------
    record
        With noise, drift, gaps and outages: all that training may see.
    truth
        The same sensors without error and without gaps, to score against.
    """

    record: FieldRecord
    truth: FieldRecord


def virtual_field(
    cage: Cage,
    buoy: Record,
    *,
    hidden: Hidden,
    seed: int,
    every_s: float = 60.0,
    responses: str | Path | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> VirtualField:
    """Sensors on a cage that differs from its drawing, in a current that differs from the buoy's.

    The cage answers at once: its equilibria are settled on a grid of currents and growths
    and interpolated, with the error on the record's notes. Waves, depth profile and inertia
    are left out. The buoy's stream passes through as it came.

    Parameters
    ----------
    cage
        As drawn; its sensors are the ones simulated.
    buoy
        What the buoy reported, generated or measured.
    hidden
        How the truth differs.
    seed
        Of noise and outages. The hidden cage does not depend on it.
    every_s
        Time between readings [s].
    responses
        Folder that keeps the settled grid (about 500 equilibria) for the next call; None
        settles it anew.
    workers
        Processes; None for one per available core.
    progress
        Called as ("virtual field", done, total) in equilibria.
    """
    rng, *sensor_rngs = np.random.default_rng(seed).spawn(1 + len(cage.sensor_names))
    time = _times(buoy, every_s)
    seconds = (time - buoy.time[0]) / np.timedelta64(1, "s")
    velocity = current_at_cage(buoy, seconds, hidden=hidden, rng=rng)
    with nullcontext(responses) if responses else tempfile.TemporaryDirectory() as folder:
        answers, error = true_responses(
            cage, hidden, store=Path(folder), workers=workers, progress=progress
        )
    exact = answers.at(velocity, hidden.fouling.grown(seconds / _DAY))
    sensors = _exact_sensors(cage, time, exact)
    truth = FieldRecord(
        cage=cage.name,
        buoy=buoy,
        sensors=sensors,
        origin=Origin.VIRTUAL_FIELD,
        hidden_sha256=hidden.sha256,
        notes=(f"Virtual field, seed {seed}.", *_interpolation_notes(cage, error)),
    )
    seen = {
        name: sensed(sensor, hidden, own)
        for (name, sensor), own in zip(sensors.items(), sensor_rngs, strict=True)
    }
    return VirtualField(
        record=replace(truth, sensors=seen),
        truth=replace(truth, notes=(*truth.notes, "These are the sensors without their errors.")),
    )


def current_at_cage(
    buoy: Record,
    seconds: Float[np.ndarray, " t"],
    *,
    hidden: Hidden,
    rng: np.random.Generator,
) -> Float[np.ndarray, "t 2"]:
    """The true current at the cage (east, north) [m/s].

    What the buoy reported, less the buoy's own error, arrives later, slowed and turned by
    its direction, with eddies that the buoy does not see.

    Parameters
    ----------
    buoy
        Its unusable rows are bridged by its neighbours.
    seconds
        Since the buoy's first time, in even steps [s].
    """
    there, reported = _reported(buoy)
    speed = np.linalg.norm(reported, axis=1)
    noise = hidden.buoy
    at_buoy = towards(
        np.maximum(speed - rng.normal(scale=noise.speed_sd_m_s, size=len(speed)), 0.0),
        compass(reported) - rng.normal(scale=noise.direction_sd_deg, size=len(speed)),
    )
    way = hidden.current
    now = _between(seconds, there, at_buoy)
    lag = np.minimum(way.distance_m / np.maximum(np.linalg.norm(now, axis=1), 1e-6), way.lag_most_s)
    arrived = _between(seconds - lag, there, at_buoy)
    eddies = wandering(
        rng,
        len(seconds),
        sd=way.residual_sd_m_s,
        step_s=float(seconds[1] - seconds[0]),
        memory_s=way.residual_memory_s,
    )
    return _sheltered(arrived, way) + eddies


def _times(buoy: Record, every_s: float) -> Shaped[np.ndarray, " t"]:
    """Even times over a buoy's record."""
    span = float((buoy.time[-1] - buoy.time[0]) / np.timedelta64(1, "s")) if len(buoy) else 0.0
    if not 0.0 < every_s < span:
        raise InputError(
            f"virtual_field: {buoy.stream} spans {span:g} s, which holds no two readings "
            f"every {every_s:g} s. Give a longer record or a shorter step."
        )
    return np.arange(buoy.time[0], buoy.time[-1], np.timedelta64(round(every_s * 1e6), "us"))


def _reported(
    buoy: Record,
) -> tuple[Float[np.ndarray, " row"], Float[np.ndarray, "row 2"]]:
    """Times since the first row [s] and currents of the usable rows [m/s]."""
    usable = buoy.usable("current_speed_m_s") & buoy.usable("current_to_deg")
    if np.sum(usable) < 2:
        raise InputError(
            f"{buoy.stream}: {np.sum(usable)} usable currents in {len(buoy)} rows. "
            "A virtual field needs two at least."
        )
    seconds = (buoy.time - buoy.time[0]) / np.timedelta64(1, "s")
    velocity = towards(buoy.values["current_speed_m_s"], buoy.values["current_to_deg"])
    return seconds[usable], velocity[usable]


def _between(
    at: Float[np.ndarray, " t"],
    seconds: Float[np.ndarray, " row"],
    velocity: Float[np.ndarray, "row 2"],
) -> Float[np.ndarray, "t 2"]:
    return np.column_stack([np.interp(at, seconds, component) for component in velocity.T])


def _sheltered(velocity: Float[np.ndarray, "t 2"], way: HiddenCurrent) -> Float[np.ndarray, "t 2"]:
    """Slowed and turned on its way, smoothly by direction."""
    to = compass(velocity)
    factor = _swing(to, way.factor_least, way.factor_most, way.factor_most_to_deg)
    turn = _swing(to, way.turn_least_deg, way.turn_most_deg, way.turn_most_to_deg)
    return towards(np.linalg.norm(velocity, axis=1) * factor, to + turn)


def _swing(
    to: Float[np.ndarray, " t"], least: float, most: float, most_to: float
) -> Float[np.ndarray, " t"]:
    """From least to most and back, once round the compass."""
    share = (1.0 + np.cos(np.deg2rad(to - most_to))) / 2.0
    return least + (most - least) * share


def _exact_sensors(
    cage: Cage, time: Shaped[np.ndarray, " t"], exact: Float[np.ndarray, "t sensor"]
) -> dict[str, Record]:
    keys = ["depth_m"] * len(cage.depth_sensors) + ["tension_kn"] * len(cage.shackles)
    return {
        name: Record(stream=name, time=time, values={key: column}, origin=Origin.VIRTUAL_FIELD)
        for name, key, column in zip(cage.sensor_names, keys, exact.T, strict=True)
    }


def _interpolation_notes(cage: Cage, error: Float[np.ndarray, "case sensor"]) -> tuple[str, ...]:
    units = ["m"] * len(cage.depth_sensors) + ["kN"] * len(cage.shackles)
    return tuple(
        f"{name}: interpolated between settled equilibria; at {len(column)} others the error "
        f"is {np.mean(column):.2g} {unit} on average, {np.max(column):.2g} {unit} at most."
        for name, unit, column in zip(cage.sensor_names, units, np.abs(error).T, strict=True)
    )
