"""From the twin's answers to the JSON of the doors: the one place where SI is left."""

import hashlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from datetime import UTC, datetime
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, mooring_lines
from seacage.conventions import Flag, compass
from seacage.dynamics import line_ends
from seacage.ocean import SeaState
from seacage.records import Record, Sample
from seacage.service._export import Output, bridle_outputs, sensor_outputs
from seacage.service._live._damage import LineDamage
from seacage.service._schemas import _cages as schemas
from seacage.service._schemas import _state as states
from seacage.twin import (
    NO_PARTED_LINES,
    Answer,
    Answered,
    IfParted,
    Metocean,
    Twin,
    TwinState,
    interval_reason,
    shackle_loads,
)

_UNUSABLE = (Flag.FAIL, Flag.MISSING)
_ID_DIGITS = 16  # of the hash of a topology: enough that two never meet by chance
_DECIMALS = 3  # a newton, a millimetre: below what any sensor here resolves


def state_of(
    name: str,  # of the cage
    twin: Twin,
    answered: Answered,
    memory: TwinState,  # what the twin remembers of its streams
    *,
    damage: Mapping[str, LineDamage] = MappingProxyType({}),  # of the lines, as far as counted
) -> states.State:
    """Say what a cage does at one time."""
    answer = answered.answer
    lower, upper = answer.volume_interval()
    return states.State(
        cage=name,
        t=answered.t,
        age_s=_number(answered.input_age_s),
        valid=bool(answer.valid[0]),
        in_domain=bool(answer.in_domain[0]),
        reason=answer.reason[0],
        origin=str(twin.origin),
        water=_water(answered.at_buoy),
        bridles=_bridles(twin.cage, answer, shackle_loads(twin, memory, answered.t)),
        lines=_lines(twin, answer, damage),
        lines_reason=answer.line_reason[0],
        tp_assumed=bool(answer.line_tp_assumed[0]),
        sensors=_sensors(answer, memory, answered.t, twin.timeouts.sensor_silent_after_s),
        shape_level=answer.shape_level,
        shape=_shape_state(answer),
        volume_fraction=_number(answer.volume_fraction[0], 4),
        volume_fraction_lower=_number(lower[0], 4),
        volume_fraction_upper=_number(upper[0], 4),
        silent=sorted(memory.silent),
        amended=[
            states.Amended.model_validate(asdict(one) | {"quantity": one.key, "reason": one.remark})
            for one in memory.amended
        ],
    )


def loads_of(state: states.State) -> Iterator[tuple[float, str, str]]:
    """Each bridle's loads as far as they are known: share of capacity [-], bridle and shackle.

    The shackle is empty where the load is predicted.
    """
    distrusted = {one.id for one in state.alarms if one.active}
    for one in state.bridles:
        if one.utilisation is not None:
            yield one.utilisation, one.name, ""
        by, share = one.measured_by, one.measured_utilisation
        if by and share is not None and f"irregular.{by}" not in distrusted:
            yield share, one.name, by


def summary_of(name: str, state: states.State) -> schemas.CageSummary:
    """Say in one line how a cage is."""
    waiting = [alarm for alarm in state.alarms if not alarm.shelved]
    worst = max(waiting, key=lambda alarm: (alarm.active, alarm.severity), default=None)
    about = {
        "name": name,
        "max_utilisation": max((share for share, _, _ in loads_of(state)), default=None),
        "waiting": len(waiting),
        "worst_severity": worst.severity if worst else None,
        "worst_title": worst.title if worst else None,
        "worst_key": worst.key if worst else None,
        "worst_values": worst.values if worst else {},
    }
    water = dict(state.water or dict.fromkeys(states.Water.model_fields))
    return schemas.CageSummary.model_validate({**dict(state), **water, **about})


def _bridles(cage: Cage, answer: Answer, measured: Mapping[int, float]) -> list[states.BridleState]:
    capacity = cage.bridle_capacity / 1e3
    read = [measured.get(k, math.nan) / 1e3 for k in range(len(capacity))]
    shackles = {one.bridle: one.name for one in cage.shackles}
    return [
        states.BridleState(
            name=one.name,
            level=one.level,
            in_domain=bool(one.in_domain[0]),
            tension_kn=states.Interval(
                mean=_number(one.mean[0]), lower=_number(one.lower[0]), upper=_number(one.upper[0])
            ),
            interval_reason=interval_reason(known=one.calibrated),
            low_fidelity_kn=_number(one.low[0]),
            utilisation=_number(one.mean[0] / capacity[k], 4),
            measured_kn=_number(read[k]),
            measured_utilisation=_number(read[k] / capacity[k], 4),
            measured_by=shackles.get(k),
        )
        for k, one in enumerate(bridle_outputs(answer))
    ]


def _lines(twin: Twin, answer: Answer, counted: Mapping[str, LineDamage]) -> list[states.LineState]:
    """Say how all lines are loaded in waves; nothing where the sea was never learned."""
    if answer.line is None:
        return []
    loads, capacity = answer.line, twin.models.lines.capacity / 1e3
    mean, std, largest = (one.mean[0] / 1e3 for one in (loads.mean, loads.std, loads.maximum_3h))
    spread = np.where(np.isnan(std), loads.mean.std[0] / 1e3, np.nan)
    yearly = loads.damage_per_year
    known = answer.line_in_domain[0]
    lower, upper = (np.where(known, one[0], np.nan) / 1e3 for one in answer.maximum_interval())
    return [
        states.LineState(
            name=name,
            kind=answer.line_kinds[k],
            level=int(answer.line_level[k]),
            mean_kn=_number(mean[k]),
            mean_spread_kn=_number(spread[k]),
            std_kn=_number(std[k]),
            maximum_3h_kn=states.Interval(
                mean=_number(largest[k]), lower=_number(lower[k]), upper=_number(upper[k])
            ),
            utilisation=_number(largest[k] / capacity[k], 4),
            damage_per_year=_number(None if yearly is None else yearly[0, k], 9),
            **(asdict(counted[name]) if name in counted else {}),
        )
        for k, name in enumerate(answer.line_names)
    ]


def what_if_parted(name: str, twin: Twin, answered: Answered) -> schemas.WhatIfParted:
    """Say what would be left in the water of an answer if each line parted, the worst first."""
    water, reason = answered.metocean, answered.answer.reason[0]
    lines = list[schemas.PartedLine]()
    if twin.models.parted is None:
        reason = NO_PARTED_LINES
    elif water is not None and answered.answer.valid[0]:
        found = twin.if_parted(water)
        reason = found.reason[0]
        lines = _lines_if_parted(found) if np.isfinite(found.mean[0]).any() else []
    lines.sort(key=_badness, reverse=True)
    return schemas.WhatIfParted(
        cage=name, time=answered.t, level=1, reason=reason or None, lines=lines
    )


def _lines_if_parted(found: IfParted) -> list[schemas.PartedLine]:
    second = found.second_would_part[0]
    return [
        schemas.PartedLine(
            parted=parted,
            kind=found.kinds[row],
            in_domain=bool(found.in_domain[0, row]),
            largest_mean=_load_on(found, found.mean[0, row], int(found.largest_mean[0, row])),
            largest_maximum_3h=_load_on(
                found, found.maximum_3h[0, row], int(found.largest_maximum_3h[0, row])
            ),
            utilisation=_number(found.utilisation[0, row], 4),
            second_would_part=bool(second[row]) if math.isfinite(second[row]) else None,
            volume_share=_number(found.volume_share[0, row], 4),
            clearance_m=_number(found.clearance[0, row], 1),
            drift_m=_number(found.drift[0, row], 1),
        )
        for row, parted in enumerate(found.parted)
    ]


def _load_on(found: IfParted, load: Float[np.ndarray, " line"], k: int) -> schemas.LineLoad | None:
    if (kn := _number(load[k] / 1e3)) is None:
        return None
    return schemas.LineLoad(line=found.line_names[k], kn=kn)


def _badness(line: schemas.PartedLine) -> tuple[bool, float, float]:
    load = line.largest_maximum_3h or line.largest_mean
    return bool(line.second_would_part), line.utilisation or 0.0, load.kn if load else 0.0


def _sensors(
    answer: Answer, memory: TwinState, now: datetime, silent_after_s: float
) -> list[states.SensorState]:
    found = list[states.SensorState]()
    depths = answer.depth_std_level.tolist()
    for column, one in enumerate(sensor_outputs(answer)):
        std = _number(answer.depth_std[0, column]) if column < len(depths) else None
        sample = memory.latest(one.name, now)
        measured = usable_value(sample) if sample else None
        age = (now - sample.t).total_seconds() if sample and measured is not None else None
        fresh = age is not None and age <= silent_after_s
        found.append(
            states.SensorState(
                name=one.name,
                unit=one.unit,
                level=one.level,
                in_domain=bool(one.in_domain[0]),
                low_fidelity=_number(one.low[0]),
                mean=_number(one.mean[0]),
                lower=_number(one.lower[0]),
                upper=_number(one.upper[0]),
                std=std,
                std_level=None if std is None else depths[column],
                interval_reason=interval_reason(known=one.calibrated),
                measured=_number(measured) if fresh else None,
                measured_age_s=_number(age) if fresh else None,
            )
        )
    return found


def usable_value(sample: Sample, key: str | None = None) -> float | None:
    """Read a value of a sample; None where it failed its checks, or is not there.

    ``key``: of the quantity; None for the one quantity of a sensor.
    """
    key = key or next(iter(sample.values))
    value, flag = sample.values.get(key, math.nan), sample.flags.get(key, Flag.MISSING)
    return value if flag not in _UNUSABLE and math.isfinite(value) else None


def shape_of(answered: Answered) -> states.Shape:
    """Say where the net is at one time; nowhere without valid input."""
    answer, about = answered.answer, _shape_state(answered.answer)
    valid = bool(answer.valid[0])
    known = valid and about.interval_reason is None
    return states.Shape(
        t=answered.t,
        valid=valid,
        node_position_m=answer.node_position[0].round(_DECIMALS).tolist() if valid else [],
        sigma_m=answer.node_std[0].max(axis=1).round(_DECIMALS).tolist() if known else None,
        **dict(about),
    )


def _shape_state(answer: Answer) -> states.ShapeState:
    return states.ShapeState(
        level=answer.shape_level,
        in_domain=bool(answer.in_domain[0]),
        interval_reason=interval_reason(known=answer.shape_level > 1),
    )


def topology_of(name: str, twin: Twin, *, speed: float) -> schemas.Topology:
    """Say what of a cage does not change."""
    cage = twin.cage
    rest = twin.predict(SeaState(current_speed=0.0, current_to=0.0))
    topology = schemas.Topology(
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
        depth_sensors=[
            schemas.Position(name=one.name, node=one.node) for one in cage.depth_sensors
        ],
        shackles=[schemas.ShacklePlace(name=one.name, bridle=one.bridle) for one in cage.shackles],
        lines=_line_places(cage, rest.line_names),
        water_depth_m=cage.site.water_depth,
        stale_after_s=twin.timeouts.stale_after_s,
        speed=speed,
    )
    digest = hashlib.sha256(topology.model_dump_json().encode()).hexdigest()
    return topology.model_copy(update={"topology_id": digest[:_ID_DIGITS]})


def _line_places(cage: Cage, known: tuple[str, ...]) -> list[schemas.LinePlace]:
    """Say where the lines besides the bridles run whose loads are known."""
    every = mooring_lines(cage, anchored=True)
    if set(known) <= set(cage.bridle_names) or not set(known) <= set(every.names):
        return []
    ends = line_ends(cage).round(_DECIMALS).tolist()
    return [
        schemas.LinePlace(name=name, kind=kind, ends_m=its)
        for name, kind, its in zip(every.names, every.kinds, ends, strict=True)
        if name in known and name not in cage.bridle_names
    ]


def history_of(
    buoy: Record,
    answer: Answer,  # one row each
    measured: Mapping[str, states.Measured],  # what each sensor read in the same time
    *,
    twin: str,  # hash of the one that answered
    thinned: bool,  # whether the buoy read more often than these readings say
) -> states.History:
    """Say what the twin answers to each reading of a buoy."""
    times = [t.replace(tzinfo=UTC) for t in buoy.time.tolist()]
    lower, upper = answer.volume_interval()
    return states.History(
        twin=twin,
        t=times,
        valid=answer.valid.tolist(),
        in_domain=answer.in_domain.tolist(),
        current_speed_m_s=_usable(buoy, "current_speed_m_s"),
        current_to_deg=_usable(buoy, "current_to_deg"),
        bridles={one.name: _series(one) for one in bridle_outputs(answer)},
        sensors={one.name: _series(one) for one in sensor_outputs(answer)},
        measured=dict(measured),
        volume_fraction=_column(answer.volume_fraction),
        volume_fraction_lower=_column(lower),
        volume_fraction_upper=_column(upper),
        thinned=thinned,
    )


def _series(one: Output) -> states.Series:
    return states.Series(
        unit=one.unit,
        level=one.level,
        in_domain=one.in_domain.tolist(),
        low_fidelity=_column(one.low),
        mean=_column(one.mean),
        lower=_column(one.lower),
        upper=_column(one.upper),
        interval_reason=interval_reason(known=one.calibrated),
    )


def _water(metocean: Metocean | None) -> states.Water | None:
    if metocean is None:
        return None
    velocity = metocean.current_velocity[0]
    return states.Water(
        current_speed_m_s=_number(float(np.hypot(*velocity))),
        current_to_deg=_number(float(compass(velocity)), 1),
        hs_m=_number(metocean.hs[0], 2),
        tp_s=_number(metocean.tp[0] or None, 2),  # 0 in a sea without waves
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
