"""A virtual field: a truth that the low fidelity misses, seen by imperfect sensors."""

import tempfile
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from jaxtyping import Float, Shaped

from seacage.cage import Cage
from seacage.campaigns._buoy_records import seconds_of
from seacage.campaigns._virtual_field import _sensors
from seacage.campaigns._virtual_field._adcp import (
    Place,
    bins_of_settled,
    bins_of_simulated,
    with_bins,
)
from seacage.campaigns._virtual_field._events import Event
from seacage.campaigns._virtual_field._responses import Responses, true_responses
from seacage.campaigns._virtual_field._simulated import (
    FieldRequest,
    Truth,
    gather_truth,
    simulate_share,
)
from seacage.campaigns._virtual_field._timetable import Timetable, reading_times
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.campaigns._virtual_field._weather import Even, current_at_cage, shear, water_chance
from seacage.conventions import InputError, Origin, Progress
from seacage.records import FieldRecord, Record, TrueMeans

_DAY = 86400.0
# Of a shear that grows linearly with depth, mean over the net's depth [-]
_MEAN_SHEAR = 0.5
_EXACT = "These are the sensors without their errors."
FieldMethod = Literal["simulate", "settle"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class VirtualField:
    """Readings of the virtual sensors, and the truth behind them."""

    record: FieldRecord  # with noise, drift, gaps and outages: all that training may see
    truth: FieldRecord  # the same sensors without error and outages, to score against
    means: TrueMeans | None = None  # what no sensor sees; None where the cage was settled

    def write(self, folder: Path | str) -> None:
        """Write the record, and in its folder ``truth`` the truth.

        The record's ``field.json`` comes last: a folder that has it is whole.
        """
        folder = Path(folder)
        self.truth.write(folder / "truth")
        if self.means is not None:
            self.means.write(folder / "truth")
        self.record.write(folder)


def virtual_field(
    cage: Cage,
    buoy: Record,
    *,
    hidden: TruthParameters,
    seed: int,
    method: FieldMethod = "simulate",
    waves: Record | None = None,
    events: Sequence[Event] = (),
    every_s: float | None = None,
    timetable: Timetable | None = None,
    profile: Place | None = None,
    kept: str | Path | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> VirtualField:
    """Sensors on a cage that differs from its drawing, in a current that differs from the buoy's.

    Simulated, the cage moves in waves and in a current that changes with time and depth, under
    growth. Settled, it answers at once: its equilibria are interpolated on a grid of currents and
    growths, with the error on the record's notes; waves, depth profile and inertia are left out, of
    a shear its mean over the net's depth is kept, and the buoy's stream passes through as it came.
    With a profile the settled cage feels the shear itself, to first order.

    Parameters
    ----------
    cage
        As drawn; its sensors are the ones simulated.
    buoy
        What the buoy measured, generated or real. Its waves are those at the cage if it
        carries any.
    hidden
        How the truth differs.
    seed
        Of weather, noise and outages. The hidden cage does not depend on it.
    method
        "simulate" takes hours of computing for weeks, "settle" minutes.
    waves
        Beside the buoy's current; None for the buoy's own, or none.
    events
        What goes wrong, and when.
    every_s
        Time between readings [s]; None for 2 s simulated, 60 s settled.
    timetable
        How simulated time is cut; None for ``Timetable.over`` the buoy's record.
    profile
        Where an ADCP measures the current at several depths, which the buoy's stream then carries:
        at the buoy or at the cage. None for no ADCP.
    kept
        Folder that keeps finished stretches, or the settled grid, for another call: after a
        stop it goes on from them, to the same bits. None begins anew.
    workers
        Processes; None for one per available core. The numbers do not depend on it.
    progress
        Called as ("virtual field", done, total), in simulated hours or in equilibria.

    Raises InputError: a record too short, events that cannot be, ``kept`` of another field; waves,
    events or a timetable for a settled field.
    """
    if method == "simulate":
        truth = {"hidden": hidden, "seed": seed, "waves": waves, "events": events}
        request = _request(cage, buoy, every_s=every_s, timetable=timetable, **truth)
        with _folder(kept) as folder:
            stretches = simulate_share(request, Path(folder), workers=workers, progress=progress)
            return _simulate(request, gather_truth(request, stretches), profile)
    if waves is not None or events or timetable is not None:
        raise InputError(
            "virtual_field: a settled field has no waves, no events and no timetable. "
            'Leave them out, or take method="simulate".'
        )
    time = reading_times(buoy, every_s, usual_s=60.0)
    with _folder(kept) as store:
        options: dict[str, Any] = {"workers": workers, "progress": progress}
        grid = true_responses(cage, hidden, sheared=bool(profile), store=Path(store), **options)
    return _settle(cage, buoy, time, *grid, hidden=hidden, seed=seed, profile=profile)


def virtual_field_share(
    cage: Cage,
    buoy: Record,
    *,
    kept: str | Path,
    share: tuple[int, int],
    workers: int | None = None,
    progress: Progress | None = None,
    **field: Any,
) -> None:
    """Simulate every n-th stretch of a virtual field, on one of several machines perhaps.

    ``virtual_field`` with the same words puts the field together, and simulates what is missing.

    ``cage``, ``buoy``, ``workers``, ``progress``, ``field``: as for ``virtual_field``, to which
    also hidden, seed, waves, events, every_s and timetable are given.
    ``kept``: folder of the finished stretches.
    ``share``: which share, from 0, and of how many.
    """
    request = _request(cage, buoy, **field)
    simulate_share(request, Path(kept), share=share, workers=workers, progress=progress)


def _request(
    cage: Cage,
    buoy: Record,
    *,
    every_s: float | None = None,
    timetable: Timetable | None = None,
    hidden: TruthParameters,
    **truth: Any,
) -> FieldRequest:
    """A request whose readings and stretches are as given or as usual."""
    time = reading_times(buoy, every_s)
    timetable = timetable or Timetable.over(buoy, refined=hidden.netting.refined)
    truth |= {"hidden": hidden, "time": time, "timetable": timetable}
    return FieldRequest(cage=cage, buoy=buoy, **truth)


def _folder(kept: str | Path | None) -> AbstractContextManager[str | Path]:
    return tempfile.TemporaryDirectory() if kept is None else nullcontext(kept)


def _simulate(request: FieldRequest, truth: Truth, profile: Place | None) -> VirtualField:
    """Give the truth to the sensors, and the buoy's word to the radio."""
    cage, hidden, time, seed = request.cage, request.hidden, request.time, request.seed
    chance = np.random.default_rng([seed, *b"sensors"])
    radio, air, at_buoy, *own = chance.spawn(3 + len(cage.sensor_names))
    silence = _sensors.radio_silence(hidden, time, radio)
    known = truth.available
    pressure = _sensors.air_pressure(hidden, time, air)[known]
    heads = [*truth.wave_head[known].T, *[None] * len(cage.shackles)]
    exact = _exact_sensors(cage, time[known], truth.readings(cage)[known])
    faults: dict[str, Any] = {"silence": silence, "events": request.events}
    seen = {
        name: _sensors.sense(exact[name], hidden, rng, wave_head=head, pressure=pressure, **faults)
        for name, head, rng in zip(exact, heads, own, strict=True)
    }
    buoy = request.buoy
    if profile is not None:
        rng, weather = water_chance(seed)[0], request.weather
        bins = bins_of_simulated(buoy, profile, weather, hidden=hidden, rng=rng, seed=seed)
        buoy = with_bins(buoy, bins, seed=seed)
    record = FieldRecord(
        cage=cage.name,
        buoy=_sensors.receive_buoy(buoy, hidden, at_buoy, **faults),
        sensors=seen,
        origin=Origin.VIRTUAL_FIELD,
        hidden_sha256=hidden.sha256,
        notes=_simulation_notes(request, truth),
    )
    notes = (*record.notes, *(f"Event: {event}." for event in request.events), _EXACT)
    exactly = replace(record, buoy=request.buoy, sensors=exact, notes=notes)
    return VirtualField(record=record, truth=exactly, means=truth.means)


def _simulation_notes(request: FieldRequest, truth: Truth) -> tuple[str, ...]:
    timetable = request.timetable
    every = f"a reading every {request.every:g} s"
    notes = [f"Virtual field, seed {request.seed}, simulated in time, {every}."]
    notes += [request.hidden.title] if request.hidden.title else []
    if timetable.one_in > 1:
        notes.append(
            f"Of {timetable.one_in} stretches of {timetable.stretch:g} s one was simulated, and "
            "those in which the load shackles live; the others are gaps."
        )
    if truth.lost:
        first = request.time[truth.lost[0].first].astype("datetime64[s]")
        notes.append(
            f"{len(truth.lost)} of {len(request.stretches)} stretches did not stay finite, the "
            f"first at {first}Z; they are gaps."
        )
    return tuple(notes)


def _settle(
    cage: Cage,
    buoy: Record,
    time: Shaped[np.ndarray, " t"],
    answers: Responses,
    error: Float[np.ndarray, "case sensor"],  # of the answers
    *,
    hidden: TruthParameters,
    seed: int,
    profile: Place | None = None,
) -> VirtualField:
    """The current as it is, its answers, and what the sensors make of them."""
    _, *own = np.random.default_rng(seed).spawn(1 + len(cage.sensor_names))
    seconds = seconds_of(time, buoy.time[0])
    velocity = _current_over_net(buoy, seconds, hidden=hidden, seed=seed)
    step = float(seconds[1] - seconds[0])
    sheared = None if profile is None else shear(hidden.profile, len(seconds), step, seed=seed)
    exact = answers.at(velocity, hidden.fouling.grown(seconds / _DAY), shear=sheared)
    truth = FieldRecord(
        cage=cage.name,
        buoy=buoy,
        sensors=_exact_sensors(cage, time, exact),
        origin=Origin.VIRTUAL_FIELD,
        hidden_sha256=hidden.sha256,
        notes=(
            f"Virtual field, seed {seed}.",
            *((hidden.title,) if hidden.title else ()),
            *_interpolation_notes(cage, error),
        ),
    )
    seen = {
        name: _sensors.sense(sensor, hidden, rng)
        for (name, sensor), rng in zip(truth.sensors.items(), own, strict=True)
    }
    exactly = replace(truth, notes=(*truth.notes, _EXACT))
    if profile is not None and sheared is not None:
        at_cage = Even(step=step, values=velocity), Even(step=step, values=sheared)
        (rng,) = np.random.default_rng(seed).spawn(1)
        bins = bins_of_settled(buoy, profile, at_cage, hidden=hidden, rng=rng, seed=seed)
        truth = replace(truth, buoy=with_bins(buoy, bins, seed=seed))
    return VirtualField(record=replace(truth, sensors=seen), truth=exactly)


def true_nets(
    cage: Cage,
    buoy: Record,
    time: Shaped[np.ndarray, " t"],
    *,
    hidden: TruthParameters,
    seed: int,
    kept: str | Path,
    workers: int | None = None,
) -> Float[np.ndarray, "t node 3"]:
    """Positions of the true net's nodes in a settled virtual field [m].

    ``time``: of the field's readings, as it reads every minute. All others: as for
    ``virtual_field``, which has filled ``kept`` with the equilibria that are interpolated here.
    """
    seconds = seconds_of(reading_times(buoy, None, usual_s=60.0), buoy.time[0])
    rows = np.searchsorted(seconds, seconds_of(time, buoy.time[0]))
    velocity = _current_over_net(buoy, seconds, hidden=hidden, seed=seed)[rows]
    answers, _ = true_responses(
        cage,
        hidden,
        readings=lambda _, one: one.node_position.reshape(len(one), -1),
        store=Path(kept),
        workers=workers,
    )
    flat = answers.answers_of(velocity, hidden.fouling.grown(seconds[rows] / _DAY))
    return flat.reshape(len(rows), -1, 3)


def _current_over_net(
    buoy: Record, seconds: Float[np.ndarray, " t"], *, hidden: TruthParameters, seed: int
) -> Float[np.ndarray, "t 2"]:
    """Mean current over the net's depth in a settled field, at even times [m/s]."""
    (rng,) = np.random.default_rng(seed).spawn(1)
    velocity = current_at_cage(buoy, seconds, hidden=hidden, rng=rng)
    step = float(seconds[1] - seconds[0])
    return velocity + _MEAN_SHEAR * shear(hidden.profile, len(seconds), step, seed=seed)


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
