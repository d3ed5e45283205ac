"""Whether the demonstration's probabilities of clearance hold, as docs/rov.md has them.

    python tools/score_clearance.py OUT [--workers 2]

Makes the demonstration in OUT, or finds it there, and asks its twin about points and paths near
true nets of seeds that it did not learn from; then of a cage that is sheltered and turned from
the other side, fouled half as much again and rigged anew. Virtual field throughout.
"""

import argparse
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from seacage.campaigns import TrueShapes, TruthParameters, true_shapes
from seacage.studies import Reliability, prepare_demonstration, score_paths, score_points
from seacage.twin import Metocean, Twin

SEEDS, CASES = range(50, 56), 60
OTHER_SEEDS, OTHER_CASES = range(60, 63), 40
SPEEDS = 0.0, 0.3, 0.6, 0.9, 1.3
"""Ranges of the current's speed that a mean is formed over [m/s]."""


def main() -> None:
    """Print the tables."""
    options = argparse.ArgumentParser(description="Score the demonstration's clearances.")
    options.add_argument("out", type=Path, help="of the demonstration; goes on where it was")
    options.add_argument("--workers", type=int)
    given = options.parse_args()
    made = prepare_demonstration(given.out, workers=given.workers)
    twin, hidden = Twin.read(made.twin_folder), TruthParameters.read()
    shapes = true_shapes(twin.cage, hidden=hidden, seeds=SEEDS, cases=CASES, workers=given.workers)
    points = score_points(twin, shapes)
    _show("points", points)
    _show("points, without discrepancy", score_points(replace(twin, discrepancy=None), shapes))
    for least, most in pairwise(SPEEDS):
        some = (points.speed >= least) & (points.speed < most)
        print(
            f"  {least} to {most} m/s: {some.sum()} points, foretold {points.p[some].mean():.3f}, "
            f"happened {points.happened[some].mean():.3f}"
        )
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


def _show(what: str, scores: Reliability, *, bins: int = 10) -> None:
    happened = scores.happened.astype(float)
    brier = np.mean((scores.p - happened) ** 2)
    print(
        f"{what}: {len(happened)}, foretold {scores.p.mean():.3f}, happened {happened.mean():.3f}"
    )
    print(f"  Brier score {brier:.3f}, of whoever always says the mean {happened.var():.3f}")
    for count, foretold, share in scores.table(bins=bins):
        print(f"  | {count:,} | {foretold:.3f} | {share:.3f} |", flush=True)


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
