"""From the twin's answers to the JSON of the doors: the one place where SI is left."""

import hashlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from datetime import UTC, datetime

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, mooring_lines
from seacage.conventions import Flag, compass
from seacage.ocean import SeaState
from seacage.records import Record, Sample
from seacage.service._export import Output, bridle_outputs, sensor_outputs
from seacage.service._schemas._cages import CageSummary, Position, ShacklePlace, Topology
from seacage.service._schemas._history import History, Measured, Series
from seacage.service._schemas._samples import SampleOut
from seacage.service._schemas._state import (
    Amended,
    BridleState,
    Interval,
    LineState,
    SensorState,
    Shape,
    ShapeState,
    State,
    Water,
)
from seacage.twin import Answer, Answered, Metocean, Twin, TwinState, interval_reason, shackle_loads

_UNUSABLE = (Flag.FAIL, Flag.MISSING)
_PERIOD = "tp_s"
_ID_DIGITS = 16  # of the hash of a topology: enough that two never meet by chance
_DECIMALS = 3  # a newton, a millimetre: below what any sensor here resolves


def state_of(name: str, twin: Twin, answered: Answered, memory: TwinState) -> State:
    """Say what a cage does at one time.

    ``name``: of the cage. ``memory``: what the twin remembers of its streams.
    """
    answer = answered.answer
    return State(
        cage=name,
        t=answered.t,
        age_s=_number(answered.input_age_s),
        valid=bool(answer.valid[0]),
        in_domain=bool(answer.in_domain[0]),
        reason=answer.reason[0],
        origin=str(twin.origin),
        water=_water(answered.metocean, _period(memory, twin.buoy, answered.t)),
        bridles=_bridles(twin.cage, answer, shackle_loads(twin, memory, answered.t)),
        lines=_lines(twin.cage, answer),
        lines_reason=answer.line_reason[0],
        sensors=_sensors(answer, memory, answered.t, twin.timeouts.sensor_silent_after_s),
        shape_level=answer.shape_level,
        shape=_shape_state(answer),
        volume_fraction=_number(answer.volume_fraction[0], 4),
        silent=sorted(memory.silent),
        amended=[
            Amended.model_validate(asdict(one) | {"quantity": one.key, "reason": one.remark})
            for one in memory.amended
        ],
    )


def loads_of(state: State) -> Iterator[tuple[float, str, str]]:
    """Each bridle's loads as far as they are known: share of capacity [-], bridle and source."""
    distrusted = {one.id for one in state.alarms if one.active}
    for one in state.bridles:
        if one.utilisation is not None:
            yield one.utilisation, one.name, "predicted"
        by, share = one.measured_by, one.measured_utilisation
        if share is not None and f"irregular.{by}" not in distrusted:
            yield share, one.name, f"measured by {by}"


def summary_of(name: str, state: State) -> CageSummary:
    """Say in one line how a cage is."""
    waiting = [alarm for alarm in state.alarms if not alarm.shelved]
    worst = max(waiting, key=lambda alarm: (alarm.active, alarm.severity), default=None)
    about = {
        "name": name,
        "max_utilisation": max((share for share, _, _ in loads_of(state)), default=None),
        "waiting": len(waiting),
        "worst_severity": worst.severity if worst else None,
        "worst_title": worst.title if worst else None,
    }
    water = dict(state.water or dict.fromkeys(Water.model_fields))
    return CageSummary.model_validate({**dict(state), **water, **about})


def _bridles(cage: Cage, answer: Answer, measured: Mapping[int, float]) -> list[BridleState]:
    tension, (lower, upper) = answer.bridle_tension.mean[0], answer.bridle_interval()
    read = [measured.get(k, math.nan) for k in range(len(cage.bridle_names))]
    shackles = {one.bridle: one.name for one in cage.shackles}
    return [
        BridleState(
            name=bridle,
            level=int(answer.bridle_level[k]),
            in_domain=bool(answer.bridle_in_domain[0, k]),
            tension_kn=Interval(
                mean=_number(tension[k] / 1e3),
                lower=_number(lower[0, k] / 1e3),
                upper=_number(upper[0, k] / 1e3),
            ),
            interval_reason=interval_reason(int(answer.bridle_level[k])),
            low_fidelity_kn=_number(answer.bridle_low[0, k] / 1e3),
            utilisation=_number(tension[k] / cage.bridle_capacity[k], 4),
            measured_kn=_number(read[k] / 1e3),
            measured_utilisation=_number(read[k] / cage.bridle_capacity[k], 4),
            measured_by=shackles.get(k),
        )
        for k, bridle in enumerate(answer.bridle_names)
    ]


def _lines(cage: Cage, answer: Answer) -> list[LineState]:
    """Say how all lines are loaded in waves; nothing where the sea was never learned."""
    if answer.line is None:
        return []
    mean, std, largest = (
        np.where(answer.line_in_domain[0], one.mean[0], np.nan) / 1e3
        for one in (answer.line.mean, answer.line.std, answer.line.maximum_3h)
    )
    capacity = mooring_lines(cage, anchored=True).capacity / 1e3
    return [
        LineState(
            name=name,
            kind=answer.line_kinds[k],
            level=1,
            mean_kn=_number(mean[k]),
            std_kn=_number(std[k]),
            maximum_3h_kn=Interval(mean=_number(largest[k]), lower=None, upper=None),
            utilisation=_number(largest[k] / capacity[k], 4),
        )
        for k, name in enumerate(answer.line_names)
    ]


def _sensors(
    answer: Answer, memory: TwinState, now: datetime, silent_after_s: float
) -> list[SensorState]:
    states = list[SensorState]()
    for one in sensor_outputs(answer):
        sample = memory.latest(one.name, now)
        measured = usable_value(sample) if sample else None
        age = (now - sample.t).total_seconds() if sample and measured is not None else None
        fresh = age is not None and age <= silent_after_s
        states.append(
            SensorState(
                name=one.name,
                unit=one.unit,
                level=one.level,
                in_domain=bool(one.in_domain[0]),
                low_fidelity=_number(one.low[0]),
                mean=_number(one.mean[0]),
                lower=_number(one.lower[0]),
                upper=_number(one.upper[0]),
                interval_reason=interval_reason(one.level),
                measured=_number(measured) if fresh else None,
                measured_age_s=_number(age) if fresh else None,
            )
        )
    return states


def usable_value(sample: Sample) -> float | None:
    """Read the one value of a sensor's sample; None where it failed its checks."""
    key, value = next(iter(sample.values.items()))
    return value if sample.flags[key] not in _UNUSABLE and math.isfinite(value) else None


def shape_of(answered: Answered) -> Shape:
    """Say where the net is at one time; nowhere without valid input."""
    answer, about = answered.answer, _shape_state(answered.answer)
    valid = bool(answer.valid[0])
    known = valid and about.interval_reason is None
    return Shape(
        t=answered.t,
        valid=valid,
        node_position_m=answer.node_position[0].round(_DECIMALS).tolist() if valid else [],
        sigma_m=answer.node_sigma[0].round(_DECIMALS).tolist() if known else None,
        **dict(about),
    )


def _shape_state(answer: Answer) -> ShapeState:
    return ShapeState(
        level=answer.shape_level,
        in_domain=bool(answer.in_domain[0]),
        interval_reason=interval_reason(answer.shape_level),
    )


def topology_of(name: str, twin: Twin, *, speed: float) -> Topology:
    """Say what of a cage does not change."""
    cage = twin.cage
    rest = twin.predict(SeaState(current_speed=0.0, current_to=0.0))
    topology = Topology(
        cage=name,
        origin=str(twin.origin),
        spokes=cage.spokes,
        rings=cage.rings,
        edges=cage.edges.tolist(),
        rest_position_m=rest.node_position[0].round(_DECIMALS).tolist(),
        corner_position_m=cage.corner_position.round(_DECIMALS).tolist(),
        bridle_names=list(cage.bridle_names),
        bridle_nodes=cage.bridle_nodes.tolist(),
        bridle_corners=cage.bridle_corner.tolist(),
        bridle_capacity_kn=(cage.bridle_capacity / 1e3).round(_DECIMALS).tolist(),
        depth_sensors=[Position(name=one.name, node=one.node) for one in cage.depth_sensors],
        shackles=[ShacklePlace(name=one.name, bridle=one.bridle) for one in cage.shackles],
        stale_after_s=twin.timeouts.stale_after_s,
        speed=speed,
    )
    digest = hashlib.sha256(topology.model_dump_json().encode()).hexdigest()
    return topology.model_copy(update={"topology_id": digest[:_ID_DIGITS]})


def history_of(
    buoy: Record,
    answer: Answer,  # one row each
    measured: Mapping[str, Measured],  # what each sensor read in the same time
    *,
    thinned: bool,  # whether the buoy read more often than these readings say
) -> History:
    """Say what the twin answers to each reading of a buoy."""
    times = [t.replace(tzinfo=UTC) for t in buoy.time.tolist()]
    return History(
        t=times,
        valid=answer.valid.tolist(),
        in_domain=answer.in_domain.tolist(),
        current_speed_m_s=_usable(buoy, "current_speed_m_s"),
        current_to_deg=_usable(buoy, "current_to_deg"),
        bridles={one.name: _series(one) for one in bridle_outputs(answer)},
        sensors={one.name: _series(one) for one in sensor_outputs(answer)},
        measured=dict(measured),
        volume_fraction=_column(answer.volume_fraction),
        thinned=thinned,
    )


def _series(one: Output) -> Series:
    return Series(
        unit=one.unit,
        level=one.level,
        in_domain=one.in_domain.tolist(),
        low_fidelity=_column(one.low),
        mean=_column(one.mean),
        lower=_column(one.lower),
        upper=_column(one.upper),
        interval_reason=interval_reason(one.level),
    )


def sample_of(sample: Sample) -> SampleOut:
    """Say what is stored of a sample."""
    return SampleOut.model_validate(sample)


def _period(memory: TwinState, buoy: str, now: datetime) -> float | None:
    """The buoy's newest period, however old; None where it failed."""
    sample = memory.newest(buoy, now).get(_PERIOD)
    if sample is None or sample.flags[_PERIOD] in _UNUSABLE:
        return None
    return sample.values[_PERIOD]


def _water(metocean: Metocean | None, tp_s: float | None) -> Water | None:
    if metocean is None:
        return None
    velocity = metocean.current_velocity[0]
    return Water(
        current_speed_m_s=_number(float(np.hypot(*velocity))),
        current_to_deg=_number(float(compass(velocity)), 1),
        hs_m=_number(metocean.hs[0], 2),
        tp_s=_number(tp_s, 2),
        wave_from_deg=_number(float(compass(-metocean.wave_direction[0])), 1),
    )


def _usable(record: Record, key: str) -> list[float | None]:
    if key not in record.values:
        return [None] * len(record)
    return _column(np.where(record.usable(key), record.values[key], np.nan))


def _column(values: Float[np.ndarray, " case"]) -> list[float | None]:
    return [_number(value) for value in values.tolist()]


def _number(value: float | None, decimals: int = _DECIMALS) -> float | None:
    return None if value is None or not math.isfinite(value) else round(float(value), decimals)
