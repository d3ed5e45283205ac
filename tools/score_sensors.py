"""How near level 2 of each sensor is to the truth on cages of the family, beside five baselines.

    python tools/score_sensors.py CAMPAIGN OUT --truths 15-24 [--water coastal] [--seeds 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days; the twin trains on the first 25 (shackles on half a day), and is scored on
the last 25 against what the sensors would read without errors. The baselines are named in advance
and learn from the readings that level 2 learns from: the low fidelity as it is, a Gaussian process
of the sensor alone, AR1, least squares on (low fidelity, u, u^2, harmonics) and boosted trees.
Fields and scores are kept in OUT; stopped, it goes on. Virtual field.

With ``--profiles CAMPAIGN``, one of ``--plan profile``, the cages feel the shear, and twins that
take an ADCP's profile, at the buoy and at the cage, stand beside the twin of the current at one
depth in place of the baselines.
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from _family_fields import (
    Water,
    field_of,
    options_for,
    scored_times,
    share_by_third,
    values_at,
)

from seacage.cage import Cage
from seacage.campaigns import VirtualField
from seacage.records import read_campaign
from seacage.studies._paper._sensor_baselines import (
    SENSOR_BASELINES,
    TWIN,
    predict_by_sensor_baselines,
)
from seacage.twin import Metocean, Training, Twin, train

TRAINING = Training(restarts=1)
PROFILED = replace(TRAINING, inputs=("current", "profile"))
BASELINES = ("low fidelity", *SENSOR_BASELINES)
GROUPS = ("depth", "shackle")
# Of a sensor: its name, its level, its errors by method, and its coverage by third of the load
Score = dict[str, Any]
DRAWS = 2000  # of cages, for the intervals of ratios
WORSE = 1.05  # error over the low fidelity's from which level 2 counts as worse [-]


def main() -> None:
    """Train and score, field by field, and sum up."""
    options = options_for(__doc__, truths="15-24")
    options.add_argument("--water", choices=("tame", "coastal"), action="append")
    options.add_argument("--profiles", type=Path, metavar="CAMPAIGN")
    options.add_argument("--seeds", type=int, default=1, help="fields of each cage and water")
    given = options.parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    if given.profiles:
        sheared = replace(PROFILED, restarts=0)
        bases = base, train(cage, read_campaign(given.profiles), training=sheared)
        for water in given.water or ("tame", "coastal"):
            _score_profiles(cage, bases, water, given)
        return
    for water in given.water or ("tame", "coastal"):
        fields: list[list[Score]] = []  # of each cage
        for number in given.truths:
            fields.append([])
            for again in range(given.seeds):
                kept = given.out / f"{water}-{number}{f'-{again}' if again else ''}.json"
                if not kept.is_file():
                    where = f"cage-{number}"  # whose equilibria all its fields share
                    field = field_of(cage, number, water, given, name=where, again=again)
                    scores = list(_scores(cage, base, field))
                    kept.write_text(json.dumps(scores), encoding="utf-8")
                fields[-1] += json.loads(kept.read_text("utf-8"))
        for group in GROUPS:
            _sum_up(water, group, fields)


def _scores(cage: Cage, base: Twin, field: VirtualField) -> Iterator[Score]:
    """Errors of each sensor, by method, and how much of the truth its interval holds."""
    record, truth = field.record, field.truth
    twin = train(cage, None, record, base=base, training=TRAINING)
    time = scored_times(truth.buoy)
    water = twin.travel_time.water_at(record.buoy, time)
    answer = twin.predict(water)
    for column, name in enumerate(twin.sensor_names):
        true = values_at(truth.sensors[name], time)
        mean, std = answer.sensor.mean[:, column], answer.sensor.std[:, column]
        level_1 = answer.sensor_low.mean[:, column]
        found = {TWIN: mean, "low fidelity": level_1}
        if name in twin.models.upper:
            baselines = predict_by_sensor_baselines(twin, record, name, water, TRAINING)
            found |= {one: each.mean for one, each in baselines.items()}
        error = {one: float(np.mean(np.abs(each - true))) for one, each in found.items()}
        inside = np.abs(mean - true) <= 1.96 * std
        coverage = share_by_third(inside, level_1).tolist()
        level = int(answer.sensor_level[column])
        yield {"sensor": name, "level": level, "error": error, "coverage": coverage}


def _score_profiles(
    cage: Cage, bases: tuple[Twin, Twin], water: Water, given: argparse.Namespace
) -> None:
    """Errors of twins with a profile over those of the one without, cage by cage and together."""
    ratios: dict[tuple[str, str], list[float]] = {}
    for number in given.truths:
        kept = given.out / f"{water}-{number}-profile.json"
        if not kept.is_file():
            kept.write_text(json.dumps(_profile_scores(cage, bases, number, water, given)), "utf-8")
        rows = json.loads(kept.read_text("utf-8"))
        for place in ("buoy", "cage"):
            for group in GROUPS:
                own = [one for one in rows if one["sensor"].startswith(group)]
                ratio = np.log([one[place]["error"] / one["one depth"]["error"] for one in own])
                ratios.setdefault((place, group), []).append(float(ratio.mean()))
                cover = {
                    name: round(float(np.mean([one[name]["coverage"] for one in own])), 3)
                    for name in (place, f"{place}, given one depth")
                }
                print(
                    f"{water} {number}, {group}, profile at the {place}: "
                    f"{np.exp(ratio.mean()):.3f}, coverage {cover}"
                )
    for (place, group), all_cages in ratios.items():
        print(
            f"{water}, {group}, profile at the {place}: "
            f"{np.exp(np.mean(all_cages)):.3f} of one depth"
        )


def _profile_scores(
    cage: Cage, bases: tuple[Twin, Twin], number: int, water: Water, given: argparse.Namespace
) -> list[Score]:
    """Errors and coverage of each sensor, by what is known of the current."""
    found: dict[str, dict[str, Any]] = {}
    plain, profiled = bases
    cases: tuple[tuple[str, Literal["buoy", "cage"], Twin, Training], ...] = (
        ("one depth", "buoy", plain, TRAINING),
        ("buoy", "buoy", profiled, PROFILED),
        ("cage", "cage", profiled, PROFILED),
    )
    for name, place, base, training in cases:
        field = field_of(
            cage, number, water, given, name=f"{water}-{number}-profile", profile=place
        )
        twin = train(cage, None, field.record, base=base, training=training)
        time = scored_times(field.truth.buoy)
        known = twin.travel_time.water_at(field.record.buoy, time)
        waters: dict[str, Metocean] = {name: known}
        if name != "one depth":
            waters[f"{name}, given one depth"] = replace(known, profile=None)
        for what, one in waters.items():
            answer = twin.predict(one).sensor
            for column, sensor in enumerate(twin.sensor_names):
                off = np.abs(answer.mean[:, column] - values_at(field.truth.sensors[sensor], time))
                inside = float(np.mean(off <= 1.96 * answer.std[:, column]))
                score = {"error": float(off.mean()), "coverage": inside}
                found.setdefault(sensor, {"sensor": sensor})[what] = score
    return list(found.values())


def _sum_up(water: Water, group: str, fields: list[list[Score]]) -> None:
    own = [[one for one in field if one["sensor"].startswith(group)] for field in fields]
    rows = [one for field in own for one in field]
    cage = np.repeat(np.arange(len(own)), [len(field) for field in own])
    error = {m: np.array([one["error"].get(m, np.nan) for one in rows]) for m in (TWIN, *BASELINES)}
    print(f"{water}, {group}: {len(rows)} sensors of {len(own)} cages (virtual field)")
    for method in BASELINES:
        ratio = np.log(error[TWIN] / error[method])
        some = np.isfinite(ratio)
        low, high = _interval(ratio[some], cage[some])
        print(
            f"  over {method:12s} {np.exp(ratio[some].mean()):.3f} "
            f"[{np.exp(low):.3f}, {np.exp(high):.3f}]"
        )
    best = error[TWIN] / np.nanmin([error[method] for method in BASELINES], axis=0)
    over = error[TWIN] / error["low fidelity"]
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
