"""How far a twin's whole net is off, and how well its intervals hold, on cages of the family.

    python tools/score_net.py CAMPAIGN OUT --truths 1-26 [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan current --method settle``. Each truth is a settled
virtual field of 50 days, odd numbers in tame and even ones in coastal water; the twin trains with
the cage's own sensors, and its net is scored at 100 times of the last 25 days against the true one,
node by node along x, y and z, beside level 1. Fields are kept in OUT. Virtual field.
"""

import argparse
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
from _family_fields import field_of, options_for, scored_times, share_by_third

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, true_nets
from seacage.records import read_campaign
from seacage.twin import Training, Twin, train

EVERY = 12  # half hours of those scored
BASE: list[Twin] = []  # of a process: the twin that has learned the low fidelity


def main() -> None:
    """Train and score, truth by truth, and sum up."""
    given = options_for(__doc__, truths="1-26").parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    base = train(cage, campaign, training=Training(restarts=0))
    # Twins are inherited, not pickled: their kernels hold functions.
    with ProcessPoolExecutor(given.workers, initializer=BASE.append, initargs=(base,)) as pool:
        found = list(pool.map(partial(_score, given), given.truths))
    for name in ("node", "along x and y", "along z", "volume"):
        each = np.array([one[name] for one in found])
        print(
            f"{len(each)} truths, {name}: level 2 over level 1 {_geometric(each[:, 0]):.2f} (at "
            f"most {each[:, 0].max():.2f}), root mean square {each[:, 1].mean():.3g}; 95 % "
            f"interval holds {each[:, 2].mean():.3f}, on a cage at least {each[:, 2].min():.2f}, "
            f"below 0.85 on {np.sum(each[:, 2] < 0.85)}; by third of the size "
            f"{each[:, 4:].mean(axis=0).round(3)}; half width {each[:, 3].mean():.3g}"
        )


def _score(given: argparse.Namespace, number: int) -> Mapping[str, np.ndarray]:
    """Ratio to level 1, error, share held and half width, then the share by third."""
    base, water = BASE[0], "tame" if number % 2 else "coastal"
    field = field_of(base.cage, number, water, given, name=f"{water}-{number}")
    twin = train(base.cage, None, field.record, base=base, training=Training(restarts=1))
    buoy = field.truth.buoy
    time = scored_times(buoy)[::EVERY]
    hidden = TruthParameters.of_family(number, water=water, unseal=given.unseal)
    kept = given.out / f"{water}-{number}"
    true = true_nets(base.cage, buoy, time, hidden=hidden, seed=number, kept=kept, workers=1)
    low, best = (one.predict(one.travel_time.water_at(buoy, time)) for one in (base, twin))
    volume = base.cage.volume(true) / twin.models.still_volume
    error, of_low = true - best.node_position, true - low.node_position
    assert twin.models.net is not None  # three depth sensors trained for 25 days
    size = np.linalg.norm(best.node_position - twin.models.net.still, axis=2)[..., None]
    sizes = np.broadcast_to(size, error.shape)
    found = {
        "node": _summary(error, of_low, best.node_std, sizes),
        "along x and y": _summary(*(one[..., :2] for one in (error, of_low, best.node_std, sizes))),
        "along z": _summary(*(one[..., 2] for one in (error, of_low, best.node_std, sizes))),
        "volume": _summary(
            volume - best.volume_fraction,
            volume - low.volume_fraction,
            best.volume_std,
            1.0 - best.volume_fraction,
        ),
    }
    words = ", ".join(f"{name} {one[2]:.2f} ({one[0]:.2f})" for name, one in found.items())
    print(f"truth {number}, {water}: holds {words} of level 1's error (virtual field)", flush=True)
    return found


def _summary(
    error: np.ndarray, of_low: np.ndarray, std: np.ndarray, size: np.ndarray
) -> np.ndarray:
    off, half = float(np.sqrt(np.mean(error**2))), 1.96 * std
    held = np.abs(error) <= half
    ratio = off / float(np.sqrt(np.mean(of_low**2)))
    return np.array([ratio, off, held.mean(), half.mean(), *share_by_third(held, size)])


def _geometric(ratio: np.ndarray) -> float:
    return float(np.exp(np.mean(np.log(ratio))))


if __name__ == "__main__":
    main()
