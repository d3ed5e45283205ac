"""How near level 2 of each sensor is to the truth on cages of the family, beside five baselines.

    python tools/score_sensors.py CAMPAIGN OUT --truths 15-24 [--water coastal] [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days; the twin trains on the first 25 (shackles on half a day), and is scored on
the last 25 against what the sensors would read without errors. The baselines are named in advance
and learn from the readings that level 2 learns from: the low fidelity as it is, a Gaussian process
of the sensor alone, AR1, least squares on (low fidelity, u, u^2, harmonics) and boosted trees.
Fields and scores are kept in OUT; stopped, it goes on. Virtual field.
"""

import argparse
import json
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, VirtualField, generated_current, virtual_field
from seacage.records import read_campaign
from seacage.studies._paper._sensor_baselines import (
    SENSOR_BASELINES,
    predict_by_sensor_baselines,
)
from seacage.twin import Metocean, Training, Twin, train

START, DAYS, SCORED_FROM = datetime(2020, 1, 18, tzinfo=UTC), 50.0, 25.0
EVERY = np.timedelta64(1800, "s")
TRAINING = Training(restarts=1)
BASELINES = ("low fidelity", *SENSOR_BASELINES)
GROUPS = ("depth", "shackle")
Score = dict[
    str, Any
]  # of a sensor: its name, level, errors by method, and coverage by third of load
Water = Literal["tame", "coastal"]
DRAWS = 2000  # of cages, for the intervals of ratios
WORSE = 1.05  # error over the low fidelity's from which level 2 counts as worse [-]


def main() -> None:
    """Train and score, field by field, and sum up."""
    options = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    options.add_argument("campaign", type=Path)
    options.add_argument("out", type=Path)
    options.add_argument("--truths", type=_numbers, default=_numbers("15-24"))
    options.add_argument("--water", choices=("tame", "coastal"), action="append")
    options.add_argument("--unseal", action="store_true")
    options.add_argument("--workers", type=int)
    given = options.parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    for water in given.water or ("tame", "coastal"):
        fields: list[list[Score]] = []
        for number in given.truths:
            kept = given.out / f"{water}-{number}.json"
            if not kept.is_file():
                field = _field(cage, number, water, given)
                scores = list(_scores(cage, base, field))
                kept.write_text(json.dumps(scores), encoding="utf-8")
            fields.append(json.loads(kept.read_text("utf-8")))
        for group in GROUPS:
            _sum_up(water, group, fields)


def _numbers(words: str) -> Sequence[int]:
    first, _, last = words.partition("-")
    return range(int(first), int(last or first) + 1)


def _field(cage: Cage, number: int, water: Water, given: argparse.Namespace) -> VirtualField:
    return virtual_field(
        cage,
        generated_current(number, start=START, days=DAYS),
        hidden=TruthParameters.of_family(number, water=water, unseal=given.unseal),
        seed=number,
        method="settle",
        kept=given.out / f"{water}-{number}",
        workers=given.workers,
    )


def _scores(cage: Cage, base: Twin, field: VirtualField) -> Iterator[Score]:
    """Errors of each sensor, by method, and how much of the truth its interval holds."""
    record, truth = field.record, field.truth
    twin = train(cage, None, record, base=base, training=TRAINING)
    time = truth.buoy.time
    late = time >= time[0] + np.timedelta64(int(86400 * SCORED_FROM), "s")
    time = time[late & ((time - time[0]) % EVERY == np.timedelta64(0))]
    held = np.searchsorted(record.buoy.time, time, side="right") - 1
    water = Metocean.of_record(record.buoy).rows(held)
    answer = twin.predict(water)
    for column, name in enumerate(twin.sensor_names):
        known = truth.sensors[name]
        at = np.minimum(np.searchsorted(known.time, time), len(known) - 1)
        (key,) = known.values
        true = known.values[key][at] * (1e3 if key == "tension_kn" else 1.0)
        mean, std = answer.sensor.mean[:, column], answer.sensor.std[:, column]
        level_1 = answer.sensor_low.mean[:, column]
        found = {"twin": mean, "low fidelity": level_1}
        if name in twin.models.upper:
            found |= predict_by_sensor_baselines(twin, record, name, water, TRAINING)
        error = {one: float(np.mean(np.abs(each - true))) for one, each in found.items()}
        inside = np.abs(mean - true) <= 1.96 * std
        third = np.digitize(level_1, np.quantile(level_1, [1 / 3, 2 / 3]))
        coverage = [float(inside[third == one].mean()) for one in range(3)]
        level = int(answer.sensor_level[column])
        yield {"sensor": name, "level": level, "error": error, "coverage": coverage}


def _sum_up(water: Water, group: str, fields: list[list[Score]]) -> None:
    own = [[one for one in field if one["sensor"].startswith(group)] for field in fields]
    rows = [one for field in own for one in field]
    cage = np.repeat(np.arange(len(own)), [len(field) for field in own])
    error = {
        m: np.array([one["error"].get(m, np.nan) for one in rows]) for m in ("twin", *BASELINES)
    }
    print(f"{water}, {group}: {len(rows)} sensors of {len(own)} cages (virtual field)")
    for method in BASELINES:
        ratio = np.log(error["twin"] / error[method])
        some = np.isfinite(ratio)
        low, high = _interval(ratio[some], cage[some])
        print(
            f"  over {method:12s} {np.exp(ratio[some].mean()):.3f} "
            f"[{np.exp(low):.3f}, {np.exp(high):.3f}]"
        )
    best = error["twin"] / np.nanmin([error[method] for method in BASELINES], axis=0)
    over = error["twin"] / error["low fidelity"]
    print(
        f"  over the best of them afterwards: median {np.median(best):.2f}, 90 % quantile "
        f"{np.quantile(best, 0.9):.2f}, most {best.max():.2f}; worse than the low fidelity by 5 % "
        f"on {np.sum(over > WORSE)}, at most {over.max():.2f}"
    )
    coverage = np.array([one["coverage"] for one in rows])
    by_cage = [coverage[cage == one].mean() for one in range(len(own))]
    print(
        f"  coverage {coverage.mean():.3f}, by third {coverage.mean(axis=0).round(3)}, least "
        f"sensor {coverage.mean(axis=1).min():.2f}, least cage {min(by_cage):.2f}"
    )


def _interval(ratio: np.ndarray, cage: np.ndarray) -> np.ndarray:
    """Ends of the 95 % interval of the mean, whole cages drawn."""
    random, cages = np.random.default_rng(0), np.unique(cage)
    parts = [ratio[cage == one] for one in cages]
    drawn = random.integers(len(cages), size=(DRAWS, len(cages)))
    means = [np.concatenate([parts[one] for one in each]).mean() for each in drawn]
    return np.quantile(means, [0.025, 0.975])


if __name__ == "__main__":
    main()
