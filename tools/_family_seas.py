"""The family's true cages in time in waves, in seas as a buoy tells them."""

from dataclasses import dataclass, fields
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import Plan, TruthParameters, generated_current, generated_waves
from seacage.campaigns._virtual_field._weather import true_weather
from seacage.conventions import Origin, compass, has_answer
from seacage.dynamics import simulate
from seacage.ocean import MAX_CURRENT_SPEED, SeaState, current_modes
from seacage.records import Record, check_record

START, DAY = datetime(2020, 1, 18, tzinfo=UTC), 86400.0
TRAINED_AT, SCORED_FROM, DAYS = 5.0, 25.0, 50.0
"""Days of the record on which shackles are alive, and of which seas are scored."""
TRAINING, OF_SITE, OF_PLAN = 16, 10, 6
"""Seas of the twelve hours in which shackles are alive, and that are scored: they fill lanes."""
WINDOW, HALF_HOUR, SPIN_UP = 600.0, 1800.0, 300.0
LANE = np.arange(0.0, 3 * 3600.0, 720.0)
"""Seconds in which the buoy says the same, before and while a sea is simulated."""
NAMES = ("current_speed", "current_to", "hs", "tp", "wave_from")
Part = Literal["train", "score"]
PARTS: tuple[Part, ...] = get_args(Part)


@dataclass(frozen=True, kw_only=True)
class SeaLoads:
    """Loads of the true cage's lines in some seas: one row per sea, one column per line [N]."""

    water: np.ndarray  # speed [m/s], to [deg], Hs [m], Tp [s], from [deg], as the buoy has them
    mean: np.ndarray
    std: np.ndarray
    largest: np.ndarray
    expected_3h: np.ndarray
    damage_equivalent: np.ndarray

    @property
    def seas(self) -> list[SeaState]:
        """Sea of each row."""
        return [SeaState(**dict(zip(NAMES, row, strict=True))) for row in self.water.tolist()]


def loads_of_truth(
    cage: Cage, number: int, out: Path, *, unseal: bool = False
) -> tuple[SeaLoads, SeaLoads]:
    """Windows of ten minutes in which shackles train, and half hours that are scored.

    The water at the cage is that which the buoy reports with the truth's error, eddies, factor,
    turn and profile; growth is that of the day. Odd numbers are in tame, even ones in coastal
    water. Kept in a folder.
    """
    hidden = TruthParameters.of_family(number, water=_water(number), unseal=unseal)
    found = list[SeaLoads]()
    for part in PARTS:
        path = out / f"truth-{number}-{part}.npz"
        if not path.exists():
            out.mkdir(parents=True, exist_ok=True)
            loads = _simulated(cage, hidden, number, part)
            np.savez(path, **{one.name: getattr(loads, one.name) for one in fields(loads)})
        found.append(SeaLoads(**np.load(path)))
    return found[0], found[1]


def _water(number: int) -> Literal["tame", "coastal"]:
    return "tame" if number % 2 else "coastal"


def _simulated(cage: Cage, hidden: TruthParameters, number: int, part: Part) -> SeaLoads:
    trains = part == "train"
    day = TRAINED_AT if trains else (SCORED_FROM + DAYS) / 2.0
    growth = float(hidden.fouling.grown(np.array([day]))[0])
    seas = _weather_seas(number, part)
    seed = 1000 * number + (0 if trains else 500)
    history = simulate(
        hidden.true_cage(cage, growth),
        [_at_cage(sea, hidden, seed + row) for row, sea in enumerate(seas)],
        duration=WINDOW if trains else HALF_HOUR,
        spin_up=SPIN_UP,
        seed=seed,
        **hidden.net_loads,
        sample_every=None,
    )
    kept = has_answer(history.result)
    lines, tension = history.lines, history.lines.tension
    return SeaLoads(
        water=np.array([[getattr(sea, name) for name in NAMES] for sea in seas])[kept],
        mean=tension.mean[kept],
        std=tension.std[kept],
        largest=tension.maximum[kept],
        expected_3h=lines.extremes.expected[kept],
        damage_equivalent=lines.damage_equivalent[kept],
    )


def _weather_seas(number: int, part: Part) -> list[SeaState]:
    """Seas of twelve hours of the site's weather; or of its later days, and of the plan."""
    current = generated_current(number, start=START, days=DAYS)
    waves = generated_waves(number, start=START, days=DAYS)
    rng = np.random.default_rng([number, *b"seas"])
    spread = np.arange(TRAINING) * 0.5 / TRAINING
    later = np.sort(rng.uniform(SCORED_FROM, DAYS - 0.1, size=OF_SITE))
    found = list[SeaState]()
    for day in (TRAINED_AT + spread if part == "train" else later).tolist():
        at = np.datetime64(START.replace(tzinfo=None)) + np.timedelta64(round(day * DAY), "s")
        here, there = (int(np.searchsorted(one.time, at)) for one in (current, waves))
        hs, tp, wave_from = (
            float(waves.values[key][there]) for key in ("hs_m", "tp_s", "wave_from_deg")
        )
        found.append(
            SeaState(
                current_speed=float(current.values["current_speed_m_s"][here]),
                current_to=float(current.values["current_to_deg"][here]),
                hs=hs,
                tp=tp,
                wave_from=wave_from,
            )
        )
    return found if part == "train" else [*found, *Plan.named("loads", 200 + number, OF_PLAN).seas]


def _at_cage(sea: SeaState, hidden: TruthParameters, seed: int) -> SeaState:
    """The sea at the cage whose buoy reports another one."""
    time = np.datetime64(START.replace(tzinfo=None), "us") + (LANE * 1e6).astype("timedelta64[us]")
    buoy = check_record(
        Record(
            stream="buoy-1",
            time=time,
            values={
                "current_speed_m_s": np.full(len(LANE), sea.current_speed),
                "current_to_deg": np.full(len(LANE), sea.current_to),
            },
            origin=Origin.VIRTUAL_FIELD,
        )
    )
    weather = true_weather(buoy, None, hidden=hidden, seed=seed, every_s=60.0)
    last = LANE[-1]
    looks = np.arange(last - HALF_HOUR, last, 60.0)
    profile = np.mean([weather.current(second) for second in looks.tolist()], axis=0)
    mean, shear = current_modes(np.array(weather.level_depth), profile[None])
    return SeaState(
        current_speed=min(float(np.linalg.norm(mean)), MAX_CURRENT_SPEED),
        current_to=float(compass(mean[0])),
        current_shear=float(np.linalg.norm(shear)),
        shear_to=float(compass(shear[0])),
        hs=sea.hs,
        tp=sea.peak_period,
        wave_from=sea.wave_from,
    )
