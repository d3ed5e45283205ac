"""How well intervals of bridles' loads in waves hold those of the family's cages in time.

    python tools/score_line_intervals.py CAMPAIGN OUT --truths 25-40

CAMPAIGN is one of ``seacage campaign run --plan loads``. Each truth is simulated in 16 windows of
ten minutes, in which its shackles train, and for half an hour each in ten later seas of its site
and six of the plan: some 45 core-seconds, kept in OUT. Scored are the bridles without a shackle,
beside one width for all cages and the emulator's own intervals. Virtual field.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from _family_fields import options_for, share_by_third
from _family_seas import HALF_HOUR, WINDOW, SeaLoads, loads_of_truth

from seacage.cage import Cage
from seacage.records import read_campaign
from seacage.surrogates import LoadPrediction, Loads
from seacage.twin import Metocean, Training, Twin, train
from seacage.twin._correction import WindowErrors, with_discrepancy
from seacage.twin._correction._bridles import EXPECTED_MAXIMUM, EXPECTED_STD

THREE_HOURS = 10800.0
KINDS = "the twin's", "one width", "the emulator's"
STATISTICS = "std", "largest of half an hour", "expected 3-hour maximum", "damage-equivalent load"


def main() -> None:
    """Simulate what is missing, and score truth by truth."""
    given = options_for(__doc__, truths="25-40").parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    found = dict[tuple[str, str], list[np.ndarray]]()
    for number in given.truths:
        windows, seas = loads_of_truth(cage, number, given.out, unseal=given.unseal)
        twin = replace(base, models=replace(base.models, line_errors=_errors(base, windows)))
        for (name, kind), one in _score(twin, seas).items():
            found.setdefault((name, kind), []).append(one)
        held = ", ".join(f"{name} {found[name, KINDS[0]][-1][0].mean():.2f}" for name in STATISTICS)
        errors = list(twin.models.line_errors.values())
        std, maximum = (_root(errors, name) for name in ("std", "maximum"))
        print(
            f"truth {number}: relative errors {std:.2f} of the standard deviation, {maximum:.2f} "
            f"of the largest load; held: {held} (virtual field)",
            flush=True,
        )
    for (name, kind), each in found.items():
        _report(f"{name}, {kind}", each)


def _root(errors: list[WindowErrors], name: str) -> float:
    return float(np.sqrt(np.mean([getattr(one, name) ** 2 for one in errors])))


def _errors(twin: Twin, windows: SeaLoads) -> Mapping[str, WindowErrors]:
    """Errors of level 1 that each shackle of the cage has seen."""
    loads = twin.models.loads
    assert loads is not None
    low, inside, _ = loads.predict(Metocean.of(windows.seas), spread=False)
    found = dict[str, WindowErrors]()
    for one in twin.cage.shackles:
        errors = WindowErrors.of_windows(
            low.rows(inside),
            one.bridle,
            twin.cage.bridle_count,
            mean=windows.mean[inside, one.bridle],
            std=windows.std[inside, one.bridle],
            share=WINDOW / THREE_HOURS,
        )
        if errors is not None:
            found[one.name] = errors
    return found


def _score(twin: Twin, seas: SeaLoads) -> dict[tuple[str, str], np.ndarray]:
    """Whether intervals hold, widths, interval scores and loads, by statistic and interval."""
    water = Metocean.of(seas.seas)
    answer, emulator = twin.predict(water), twin.emulator
    assert answer.line is not None
    assert emulator is not None
    low, inside, _ = emulator.predict(water)
    bare, _, _ = emulator.predict(water, spread=False)
    mean = WindowErrors(std=EXPECTED_STD, maximum=EXPECTED_MAXIMUM)
    bridles = twin.cage.bridle_count
    fixed = with_discrepancy(bare, bare, mean, bridles=bridles, own_mean=(), rows=inside)
    shackled = [one.bridle for one in twin.cage.shackles]
    alone = np.setdiff1d(np.arange(bridles), shackled)
    short = seas.expected_3h
    truth = dict(
        zip(
            STATISTICS,
            (
                seas.std,
                seas.largest,
                # of a line that is slack nearly all the time no more is known
                np.where(np.isfinite(short), short, seas.largest),
                seas.damage_equivalent,
            ),
            strict=True,
        )
    )
    found = dict[tuple[str, str], np.ndarray]()
    for kind, loads in zip(KINDS, (answer.line, fixed, low), strict=True):
        for name, load in zip(STATISTICS, _parts(loads), strict=True):
            lower, upper = (end[inside][:, alone] for end in load.interval(0.95))
            true = truth[name][inside][:, alone]
            beyond = np.maximum(lower - true, 0.0) + np.maximum(true - upper, 0.0)
            width = upper - lower
            score = width + 40.0 * beyond  # Gneiting and Raftery (2007), for 95 %
            rows = beyond == 0.0, width, score, load.mean[inside][:, alone]
            found[name, kind] = np.stack([one.ravel() for one in rows])
    return found


def _parts(loads: Loads) -> tuple[LoadPrediction, ...]:
    half = loads.maximum_3h.of_share(HALF_HOUR / THREE_HOURS)
    return loads.std, half, loads.maximum_3h, loads.damage_equivalent


def _report(what: str, each: list[np.ndarray]) -> None:
    held = np.array([one[0].mean() for one in each])
    every = np.concatenate(each, axis=1)
    width, score = (np.mean([one[row].mean() for one in each]) / 1e3 for row in (1, 2))
    print(
        f"{what}: held {held.mean():.3f}, by third {share_by_third(every[0], every[3]).round(3)}, "
        f"least {held.min():.2f}, below 0.85 on {(held < 0.85).sum()} of {len(held)}, width "
        f"{width:.1f} kN, interval score {score:.1f} kN"
    )


if __name__ == "__main__":
    main()
