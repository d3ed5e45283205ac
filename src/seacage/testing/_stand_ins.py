"""A cage's response by formula: campaigns and field records for tests that need no simulator."""

from collections.abc import Sequence
from datetime import UTC, datetime
from functools import cache

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.conventions import Origin, compass
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, FieldRecord, Record, instant
from seacage.twin import Training, Twin, train

START = datetime(2020, 1, 18, tzinfo=UTC)


def stand_in_seas(count: int, *, seed: int = 0, current_speed: float = 1.0) -> tuple[SeaState, ...]:
    """Currents all round, up to a speed [m/s], the first of them slack."""
    random = np.random.default_rng(seed)
    speed = np.append(0.0, random.uniform(0.0, current_speed, count - 1))
    to = random.uniform(0.0, 360.0, count)
    return tuple(
        SeaState(current_speed=one, current_to=other)
        for one, other in zip(speed.tolist(), to.tolist(), strict=True)
    )


def stand_in_campaign(cage: Cage, seas: Sequence[SeaState], *, seed: int = 0) -> CampaignRecord:
    """A campaign whose nets sway and rise with the square of the current."""
    velocity = np.array([sea.current_velocity for sea in seas])
    position = _position(cage, velocity)
    cases = len(seas)
    return CampaignRecord(
        cage_toml=cage.to_toml(),
        seas=tuple(seas),
        node_position=position,
        bridle_tension=_tension(cage, velocity),
        net_force=np.zeros((cases, 3)),
        volume=cage.volume(position),
        residual=np.zeros(cases),
        result=np.zeros(cases, dtype=int),
        law="stand-in",
        seed=seed,
        version="0",
    )


def stand_in_field(
    cage: Cage, *, seed: int = 0, days: float = 4.0, buoy_s: float = 720.0, sensor_s: float = 120.0
) -> FieldRecord:
    """A buoy in a turning tide and sensors on a cage that is softer than the campaign's.

    The shackles speak on the first half day and on the last full one only.
    """
    random = np.random.default_rng(seed)
    at = np.arange(0.0, days * 86400.0, buoy_s)
    velocity = _tide(at)
    buoy = Record(
        stream="buoy-1",
        time=_times(at),
        values={
            "current_speed_m_s": np.linalg.norm(velocity, axis=1),
            "current_to_deg": compass(velocity),
        },
        origin=Origin.VIRTUAL_FIELD,
    )
    at = np.arange(0.0, days * 86400.0, sensor_s)
    felt = 1.15 * _tide(at)
    depth = -_position(cage, felt)[:, :, 2]
    tension = 1.2 * _tension(cage, felt) / 1000.0
    spoken = (at < 43200.0) | (at >= (days - 1.0) * 86400.0)
    everywhere = np.ones(len(at), dtype=bool)
    readings = [
        (one.name, "depth_m", depth[:, one.node], 0.03, everywhere) for one in cage.depth_sensors
    ] + [(one.name, "tension_kn", tension[:, one.bridle], 0.15, spoken) for one in cage.shackles]
    sensors = {
        name: Record(
            stream=name,
            time=_times(at[rows]),
            values={key: value[rows] + noise * random.standard_normal(rows.sum())},
            origin=Origin.VIRTUAL_FIELD,
        )
        for name, key, value, noise, rows in readings
    }
    return FieldRecord(cage=cage.name, buoy=buoy, sensors=sensors, origin=Origin.VIRTUAL_FIELD)


@cache
def stand_in_twin(*, spokes: int = 8) -> Twin:
    """A trained twin, small if not told otherwise, the same one for all tests of a run."""
    cage = Cage.named("ace").altered(mesh={"spokes": spokes})
    return train(
        cage,
        stand_in_campaign(cage, stand_in_seas(120)),
        stand_in_field(cage),
        training=Training(high_fidelity_points=60, days=2.0, restarts=0),
    )


def _position(
    cage: Cage, velocity: Float[np.ndarray, "case 2"]
) -> Float[np.ndarray, "case node 3"]:
    speed = np.linalg.norm(velocity, axis=1)[:, None]
    rest = cage.design_position
    depth = -rest[:, 2] / -rest[:, 2].min()
    sway = 9.0 * speed[..., None] * velocity[:, None, :] * depth[:, None]
    # The upstream side is lifted more than the lee, as on a net that leans.
    lean = 1.0 - 0.01 * (velocity @ rest[:, :2].T)
    lift = 7.0 * speed**2 * depth * lean
    return rest + np.concatenate([sway, lift[..., None]], axis=-1)


def _tension(cage: Cage, velocity: Float[np.ndarray, "case 2"]) -> Float[np.ndarray, "case line"]:
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    ends = cage.design_position[cage.bridle_nodes, :2]
    pull = cage.corner_position[cage.bridle_corner, :2] - ends
    pull /= np.linalg.norm(pull, axis=1, keepdims=True)
    load = 4e4 * speed * (-velocity @ pull.T)
    # A rope that would go slack keeps a little of its pretension.
    return 4e3 * np.logaddexp(0.0, 1.0 + load / 4e3)


def _tide(at: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 2"]:
    phase = 2.0 * np.pi * at / 44700.0
    slow = 2.0 * np.pi * at / 250000.0
    return np.column_stack(
        [0.45 * np.cos(phase) + 0.15 * np.sin(slow), 0.3 * np.sin(phase) + 0.1 * np.cos(slow)]
    )


def _times(at: Float[np.ndarray, " t"]) -> np.ndarray:
    return instant(START) + (at * 1e6).astype("timedelta64[us]")
