"""How well a twin's intervals hold the true tension of every bridle, on cages of the family.

    python tools/score_bridles.py CAMPAIGN OUT --truths 9-32 [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days, odd numbers in tame and even ones in coastal water, with a shackle on
every bridle; the twin trains with the cage's own alone, and is scored on the last 25 days against
the tensions without sensors' errors. Fields are kept in OUT; stopped, it goes on. Virtual field.
"""

import argparse

import numpy as np
from _family_fields import (
    field_of,
    options_for,
    scored_times,
    share_by_third,
    values_at,
    with_every_shackle,
    without_extra,
)

from seacage.cage import Cage
from seacage.records import FieldRecord, read_campaign
from seacage.twin import Training, Twin, train


def main() -> None:
    """Train and score, truth by truth."""
    given = options_for(__doc__, truths="9-32").parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    full = with_every_shackle(cage)
    coverage, thirds, expected = list[float](), list[np.ndarray](), list[float]()
    for number in given.truths:
        record, truth = _field(full, number, given)
        twin = train(cage, None, record, base=base, training=Training(restarts=1))
        relative = twin.models.relative_discrepancy
        held, load, width = _score(full, twin, truth)
        by_third = share_by_third(held, load)
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


def _field(cage: Cage, number: int, given: argparse.Namespace) -> tuple[FieldRecord, FieldRecord]:
    """What the twin may see of a truth, and the truth."""
    water = "tame" if number % 2 else "coastal"
    field = field_of(cage, number, water, given, name=f"truth-{number}")
    return without_extra(field.record), field.truth


def _score(cage: Cage, twin: Twin, truth: FieldRecord) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether each interval of level 1 holds the tension, the load and the width, by time."""
    time = scored_times(truth.buoy)
    answer = twin.predict(twin.travel_time.water_at(truth.buoy, time))
    true = np.full(answer.bridle_low.shape, np.nan)
    for shackle in cage.shackles:
        true[:, shackle.bridle] = values_at(truth.sensors[shackle.name], time)
    lower, upper = answer.bridle_interval()
    held, alone = (lower <= true) & (true <= upper), answer.bridle_level == 1
    return held[:, alone], answer.bridle_low[:, alone], (upper - lower)[:, alone]


if __name__ == "__main__":
    main()
