"""A campaign in waves by formula: loads of all lines that have the symmetry of their cage."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from seacage.cage import Cage, mooring_lines
from seacage.campaigns import Plan
from seacage.conventions import Origin
from seacage.dynamics import line_places
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, FieldRecord, Record
from seacage.testing import stand_in_campaign
from seacage.twin import Training, Twin, train

CAGE = Cage.named("ace").altered(mesh={"spokes": 8})
SQUARE = Cage.named("ace").altered(mesh={"spokes": 16})
"""Whose bridles are on spokes, so that it has the symmetry of a square."""

KINDS = ("bridle-1", "bridle-2", "frame-1", "anchor-1")
"""Lines that it tells apart."""

LOWER = 0.5
"""How far the waves press the net down [m]."""


def wavy_campaign(
    cases: int = 40, *, plan: str = "loads", cage: Cage = CAGE, parted: Sequence[str] = ()
) -> CampaignRecord:
    """Cases of a plan, their lines loaded by ``true_loads``, or by ``loads_without`` one."""
    seas = Plan.named(plan, 1, cases).seas
    mean, std = loads_without(cage, seas, *parted) if parted else true_loads(cage, seas)
    lines = mooring_lines(cage, anchored=True)
    largest = mean + 4.0 * std
    still = stand_in_campaign(cage, seas)
    return replace(
        still,
        duration=900.0,
        parted=tuple(parted),
        node_position_minimum=still.node_position - LOWER,
        node_position_std=true_motion(cage, seas),
        line_names=lines.names,
        line_kinds=lines.kinds,
        lines={
            "mean": mean,
            "std": std,
            "mpm_3h": mean + 3.8 * std,
            "expected_3h": largest,
            "maximum": largest,
            "damage_equivalent": np.where(np.isfinite(lines.tn_slope), 2.5 * std, np.nan),
        },
    )


@cache
def wavy_twin() -> Twin:
    """A twin that learned it, the same one for all tests of a run."""
    return train(CAGE, wavy_campaign(), training=Training(restarts=0))


@cache
def twin_of_damage() -> Twin:
    """A twin that also learned what is left if a line parts."""
    parted = [wavy_campaign(cage=SQUARE, parted=[line]) for line in KINDS]
    whole = wavy_campaign(60, cage=SQUARE)
    return train(SQUARE, whole, parted=parted, training=Training(restarts=0))


def true_loads(cage: Cage, seas: tuple[SeaState, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Mean and standard deviation of each line [N]."""
    outward = line_places(cage)[:, :2]
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    current = np.array([sea.current_velocity for sea in seas])
    waves = np.array([sea.hs * sea.wave_direction for sea in seas])
    period = np.array([max(sea.peak_period, 1.0) for sea in seas])
    mean = 4e4 - 2e4 * np.linalg.norm(current, axis=1, keepdims=True) * (current @ outward.T)
    height = np.linalg.norm(waves, axis=1, keepdims=True)
    return mean, 800.0 * (1.5 * height - waves @ outward.T) / period[:, None] ** 0.3


def true_motion(cage: Cage, seas: tuple[SeaState, ...]) -> np.ndarray:
    """Standard deviation of each node's place, the less the deeper, most along the waves [m]."""
    hs, along = np.array([sea.hs for sea in seas]), np.array([sea.wave_direction for sea in seas])
    of_node = np.exp(cage.design_position[:, 2] / 20.0)
    axes = np.column_stack([np.abs(along), np.ones(len(seas))])
    return 0.25 * (hs[:, None] * axes)[:, None, :] * of_node[:, None]


def gaussian_series(
    random: np.random.Generator, count: int, *, every: float = 0.5, tp: float = 6.0
) -> np.ndarray:
    """Gaussian process of unit variance with a narrow spectrum about 1 / tp."""
    frequency = np.fft.rfftfreq(count, every)
    amplitude = np.exp(-0.5 * ((frequency * tp - 1.0) / 0.15) ** 2)
    phase = random.standard_normal((2, len(frequency)))
    series = np.fft.irfft(amplitude * (phase[0] + 1j * phase[1]), count)
    return (series - series.mean()) / series.std()


def wavy_field(
    factor: float, *, hours: float = 12.0, every: float = 1.0, noise_kn: float = 0.15
) -> FieldRecord:
    """A buoy in a tide and rising waves, and shackle-2, whose tension scatters by a factor more."""
    random = np.random.default_rng(3)
    start = np.datetime64("2020-01-18T00:00:00", "us")
    at = np.arange(0.0, hours * 3600.0, 600.0)
    values = {
        "current_speed_m_s": 0.4 + 0.2 * np.sin(at / 7000.0),
        "current_to_deg": np.full(len(at), 40.0),
        "hs_m": 0.8 + at / at.max(),
        "tp_s": np.full(len(at), 6.0),
        "wave_from_deg": np.full(len(at), 220.0),
    }
    keys = ("current_speed", "current_to", "hs", "tp", "wave_from")
    seas = tuple(
        SeaState(**dict(zip(keys, map(float, row), strict=True)))
        for row in zip(*values.values(), strict=True)
    )
    bridle = next(one.bridle for one in CAGE.shackles if one.name == "shackle-2")
    mean, std = (one[:, bridle] for one in true_loads(CAGE, seas))
    second = np.arange(0.0, hours * 3600.0, every)
    row = (second // 600.0).astype(int)
    series = gaussian_series(random, len(second), every=every)
    tension = (mean[row] + factor * std[row] * series) / 1e3
    tension += noise_kn * random.standard_normal(len(second))

    def record(stream: str, at: np.ndarray, values: dict[str, np.ndarray]) -> Record:
        time = start + np.round(at * 1e6).astype("timedelta64[us]")
        return Record(stream=stream, time=time, values=values, origin=Origin.VIRTUAL_FIELD)

    return FieldRecord(
        cage=CAGE.name,
        buoy=record("buoy-1", at, values),
        sensors={"shackle-2": record("shackle-2", second, {"tension_kn": tension})},
        origin=Origin.VIRTUAL_FIELD,
    )


def loads_without(
    cage: Cage, seas: tuple[SeaState, ...], line: str
) -> tuple[np.ndarray, np.ndarray]:
    """The same without a line: others take its mean, the nearer the more, and sway more."""
    mean, std = true_loads(cage, seas)
    place, names = line_places(cage), mooring_lines(cage, anchored=True).names
    lost = names.index(line)
    near = np.exp(-np.linalg.norm(place - place[lost], axis=1) / 20.0)
    near[lost] = 0.0
    mean, std = mean + near / near.sum() * mean[:, [lost]], std * (1.0 + 0.5 * near)
    mean[:, lost] = std[:, lost] = 0.0
    return mean, std
