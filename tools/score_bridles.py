"""How well a twin's intervals hold the true tension of every bridle, on cages of the family.

    python tools/score_bridles.py CAMPAIGN OUT --truths 9-32 [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days, odd numbers in tame and even ones in coastal water, with a shackle on
every bridle; the twin trains with the cage's own alone, and is scored on the last 25 days against
the tensions without sensors' errors. Fields are kept in OUT; stopped, it goes on. Virtual field.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, generated_current, virtual_field
from seacage.records import FieldRecord, read_campaign
from seacage.twin import Metocean, Training, Twin, train

START, DAYS, SCORED_FROM = datetime(2020, 1, 18, tzinfo=UTC), 50.0, 25.0
EVERY = np.timedelta64(1800, "s")
EXTRA = "extra-"
"""Before the names of the shackles that the twin does not see."""


def main() -> None:
    """Train and score, truth by truth."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("campaign", type=Path)
    options.add_argument("out", type=Path)
    options.add_argument("--truths", type=_numbers, default=_numbers("9-32"))
    options.add_argument("--unseal", action="store_true")
    options.add_argument("--workers", type=int)
    given = options.parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    full = _with_every_shackle(cage)
    coverage, thirds, expected = list[float](), list[np.ndarray](), list[float]()
    for number in given.truths:
        record, truth = _field(full, number, given)
        twin = train(cage, None, record, base=base, training=Training(restarts=1))
        relative = twin.models.relative_discrepancy
        held, load, width = _score(full, twin, truth)
        by_third = _by_third(held, load)
        print(
            f"truth {number}: relative discrepancy {relative or np.nan:.2f}, level 1 holds "
            f"{held.mean():.3f}, by third of load {by_third.round(2)}, width "
            f"{width.mean() / 1e3:.1f} kN (virtual field)",
            flush=True,
        )
        coverage.append(held.mean())
        thirds.append(by_third)
        expected.append(relative or np.nan)
    print(
        f"{len(coverage)} truths: level 1 holds {np.mean(coverage):.3f}, at least "
        f"{min(coverage):.3f}, below 0.85 on {sum(one < 0.85 for one in coverage)}; by third "
        f"{np.mean(thirds, axis=0).round(3)}; root mean square of the relative discrepancy "
        f"{np.sqrt(np.mean(np.square(expected))):.2f}"
    )


def _numbers(words: str) -> Sequence[int]:
    first, _, last = words.partition("-")
    return range(int(first), int(last or first) + 1)


def _with_every_shackle(cage: Cage) -> Cage:
    seen = {one.bridle for one in cage.shackle}
    others = (k for k in range(1, cage.bridle_count + 1) if k not in seen)
    extra = (replace(cage.shackle[0], name=f"{EXTRA}{k}", bridle=k) for k in others)
    return replace(cage, shackle=(*cage.shackle, *extra))


def _field(cage: Cage, number: int, given: argparse.Namespace) -> tuple[FieldRecord, FieldRecord]:
    """What the twin may see of a truth, and the truth."""
    field = virtual_field(
        cage,
        generated_current(number, start=START, days=DAYS),
        hidden=TruthParameters.of_family(
            number, water="tame" if number % 2 else "coastal", unseal=given.unseal
        ),
        seed=number,
        method="settle",
        kept=given.out / f"truth-{number}",
        workers=given.workers,
    )
    seen = {name: one for name, one in field.record.sensors.items() if not name.startswith(EXTRA)}
    return replace(field.record, sensors=seen), field.truth


def _score(cage: Cage, twin: Twin, truth: FieldRecord) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether each interval of level 1 holds the tension, the load and the width, by time."""
    buoy = truth.buoy
    scored = buoy.time >= buoy.time[0] + np.timedelta64(int(86400 * SCORED_FROM), "s")
    rows = np.flatnonzero(scored & ((buoy.time - buoy.time[0]) % EVERY == np.timedelta64(0)))
    answer = twin.predict(Metocean.of_record(buoy).rows(rows))
    true = np.full(answer.bridle_low.shape, np.nan)
    for shackle in cage.shackles:
        record = truth.sensors[shackle.name]
        at = np.minimum(np.searchsorted(record.time, buoy.time[rows]), len(record) - 1)
        true[:, shackle.bridle] = 1e3 * record.values["tension_kn"][at]
    lower, upper = answer.bridle_interval()
    held, alone = (lower <= true) & (true <= upper), answer.bridle_level == 1
    return held[:, alone], answer.bridle_low[:, alone], (upper - lower)[:, alone]


def _by_third(held: np.ndarray, load: np.ndarray) -> np.ndarray:
    third = np.digitize(load, np.quantile(load, [1 / 3, 2 / 3]))
    return np.array([held[third == one].mean() for one in range(3)])


if __name__ == "__main__":
    main()
