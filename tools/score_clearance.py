"""Whether probabilities of clearance hold, as docs/rov.md has them. Virtual field throughout.

    python tools/score_clearance.py CAMPAIGN OUT [--truths 1-8]
    python tools/score_clearance.py - OUT [--workers 2]

With a CAMPAIGN of ``seacage campaign run --plan current --method settle``, of cages of the family,
odd numbers in tame and even ones in coastal water: each twin trains with 25 days of its cage's own
sensors, and is queried about points and paths near the true nets of the 25 days that follow.

Without one, of the demonstration, which is made in OUT or found there, with seeds that its twin did
not learn from; then of a cage that is sheltered and turned from the other side, fouled half as much
again and rigged anew.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from _family_fields import field_of, options_for, scored_times

from seacage.cage import Cage
from seacage.campaigns import TrueShapes, TruthParameters, true_nets, true_shapes
from seacage.records import read_campaign
from seacage.studies import Reliability, prepare_demonstration, score_paths, score_points
from seacage.twin import Metocean, Training, Twin, train

SEEDS, CASES = range(50, 56), 60
OTHER_SEEDS, OTHER_CASES = range(60, 63), 40
SPEEDS = 0.0, 0.3, 0.6, 0.9, 1.3
"""Ranges of the current's speed that a mean is formed over [m/s]."""


SURE = 0.01  # probability below which a pilot takes a point for clear
EVERY = 12  # half hours of the family's nets


def main() -> None:
    """Print the tables."""
    given = options_for(__doc__, truths="1-8").parse_args()
    if str(given.campaign) == "-":
        _score_demonstration(given)
    else:
        _score_family(given)


def _score_family(given: argparse.Namespace) -> None:
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    points, paths = list[Reliability](), list[Reliability]()
    for number in given.truths:
        twin, shapes = _of_truth(given, base, number)
        points.append(score_points(twin, shapes))
        paths.append(score_paths(twin, shapes))
        _show(f"truth {number}, points", points[-1], bins=5)
        print(f"  unlike the family: {twin.unlike or 'no'}", flush=True)
    _show("points", _pooled(points))
    _show_by_speed(_pooled(points))
    _show("paths", _pooled(paths), bins=5)


def _of_truth(given: argparse.Namespace, base: Twin, number: int) -> tuple[Twin, TrueShapes]:
    """A twin that trained on a truth's sensors, and the true nets of the days that follow."""
    water = "tame" if number % 2 else "coastal"
    hidden = TruthParameters.of_family(number, water=water, unseal=given.unseal)
    field = field_of(base.cage, number, water, given, name=f"{water}-{number}")
    twin = train(base.cage, None, field.record, base=base, training=Training(restarts=1))
    buoy, kept = field.truth.buoy, given.out / f"{water}-{number}"
    time = scored_times(buoy)[::EVERY]
    velocity = twin.travel_time.water_at(buoy, time).current_velocity
    net = true_nets(base.cage, buoy, time, hidden=hidden, seed=number, kept=kept, workers=1)
    return twin, TrueShapes(current_velocity=velocity, node_position=net)


def _pooled(each: Sequence[Reliability]) -> Reliability:
    names = ("p", "observed", "speed")
    return Reliability(**{name: np.concatenate([getattr(e, name) for e in each]) for name in names})


def _score_demonstration(given: argparse.Namespace) -> None:
    made = prepare_demonstration(given.out, workers=given.workers)
    twin, hidden = Twin.read(made.twin_folder), TruthParameters.read()
    shapes = true_shapes(twin.cage, hidden=hidden, seeds=SEEDS, cases=CASES, workers=given.workers)
    points = score_points(twin, shapes)
    _show("points", points)
    _show(
        "points, with the error of the family",
        score_points(replace(twin, discrepancy=None), shapes),
    )
    _show_by_speed(points)
    _show("paths", score_paths(twin, shapes), bins=5)
    _show_distances(twin, shapes)
    other = true_shapes(
        twin.cage,
        hidden=_other(hidden),
        seeds=OTHER_SEEDS,
        cases=OTHER_CASES,
        workers=given.workers,
    )
    _show("points, another cage", score_points(twin, other))


def _other(hidden: TruthParameters) -> TruthParameters:
    current, fouling = hidden.current, hidden.fouling
    return replace(
        hidden,
        current=replace(
            current,
            factor_most_to_deg=(current.factor_most_to_deg + 180.0) % 360.0,
            turn_most_to_deg=(current.turn_most_to_deg + 180.0) % 360.0,
        ),
        fouling=replace(
            fouling,
            shallow_least=1.5 * fouling.shallow_least,
            shallow_most=1.5 * fouling.shallow_most,
        ),
    ).drawn(9)


def _show_by_speed(points: Reliability) -> None:
    for least, most in pairwise(SPEEDS):
        some = (points.speed >= least) & (points.speed < most)
        if some.any():
            print(
                f"  {least} to {most} m/s: {some.sum()} points, predicted "
                f"{points.p[some].mean():.3f}, observed {points.observed[some].mean():.3f}"
            )


def _show(what: str, scores: Reliability, *, bins: int = 10) -> None:
    """Print the table, the Brier score, and the mean of |predicted - observed| over the bins."""
    observed = scores.observed.astype(float)
    rows = scores.table(bins=bins)
    off = sum(count * abs(p - share) for count, p, share in rows) / len(observed)
    sure = scores.p < SURE
    brier = np.mean((scores.p - observed) ** 2)
    print(
        f"{what}: {len(observed)}, predicted {scores.p.mean():.3f}, observed {observed.mean():.3f}"
    )
    print(
        f"  Brier score {brier:.3f}, of whoever always says the mean {observed.var():.3f}; "
        f"reliability error {off:.3f}; below {SURE:g} were predicted {sure.sum()}, of which "
        f"{observed[sure].mean() if sure.any() else 0.0:.3f} were observed"
    )
    for count, predicted, share in rows:
        print(f"  | {count:,} | {predicted:.3f} | {share:.3f} |", flush=True)


def _show_distances(twin: Twin, shapes: TrueShapes) -> None:
    velocity = shapes.current_velocity
    predicted = twin.predict(Metocean.without_waves(velocity)).node_position
    error = shapes.node_position - predicted
    collar = error[:, : twin.cage.mesh.spokes].mean(axis=1, keepdims=True)
    for what, one in (("nodes", error), ("without drift", error - collar)):
        away = np.linalg.norm(one, axis=2)
        print(
            f"{what}: {away.mean():.1f} m on average, 99 % within {np.quantile(away, 0.99):.1f} m, "
            f"worst {away.max():.0f} m, MAE of a coordinate {np.abs(one).mean():.2f} m"
        )
    drift = np.linalg.norm(collar, axis=2)
    print(f"drift: {drift.mean():.1f} m on average, {drift.max():.0f} m at most")


if __name__ == "__main__":
    main()
