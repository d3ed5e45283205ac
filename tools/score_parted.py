"""How far a twin's answer to "if this line parted" is from simulations of the damaged cage.

    python tools/score_parted.py CAMPAIGN PARTED OUT [--seas 200] [--times 4] [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan loads``, PARTED what ``--parted-lines`` left of the
same plan and seed. Other seas of that plan are simulated without each line that stands for its
kind, each so many times with other phases of the waves, and kept in OUT; stopped, it goes on. The
reference is all times of a sea together, and the largest of three hours the expected one of their
peaks. Computed, from the low fidelity's own simulations: nothing here is of a cage.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import Plan
from seacage.conventions import has_answer
from seacage.dynamics import extremes, simulate
from seacage.records import read_campaign
from seacage.twin import IfParted, Metocean, Training, train

EVERY = 0.1
"""Between samples whose peaks are counted [s]."""

AT_ONCE = 16
"""Simulations of a process's piece of work."""

PLAN_SEED, WAVE_SEED = 202, 7000
NAMED_CARRIES = 0.95
"""Of the largest load, on the line that is named."""


def main() -> None:
    """Simulate what is missing, train, and print the scores."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("campaign", type=Path)
    options.add_argument("parted", type=Path)
    options.add_argument("out", type=Path)
    options.add_argument("--seas", type=int, default=200)
    options.add_argument("--times", type=int, default=4)
    options.add_argument("--duration", type=float, default=1800.0)
    options.add_argument("--spin-up", type=float, default=300.0)
    options.add_argument("--workers", type=int, default=2)
    given = options.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    whole = read_campaign(given.campaign)
    parted = [read_campaign(store) for store in sorted(given.parted.glob("[!.]*"))]
    cage = Cage.from_toml(whole.cage_toml)
    seas = Plan.named("loads", PLAN_SEED, given.seas).seas
    work = partial(_simulate, cage, given)
    pieces = [
        (one.parted[0], first)
        for one in parted
        for first in range(0, given.seas, AT_ONCE // given.times)
    ]
    if given.workers > 1:
        with ProcessPoolExecutor(given.workers) as pool:
            list(pool.map(work, pieces))
    else:
        for piece in pieces:
            work(piece)
    twin = train(cage, whole, parted=parted, training=Training(restarts=1))
    assert twin.models.parted is not None
    print(f"{whole.converged.sum()} cases of the whole cage, {given.seas} other seas")
    for kind in twin.models.parted.kinds:
        print(f"\nwithout {kind.line}: learned from {kind.learned} of {kind.simulated} cases")
        _report(twin.if_parted(Metocean.of(seas), kind.line), given.out / kind.line)


def _simulate(cage: Cage, given: argparse.Namespace, piece: tuple[str, int]) -> None:
    line, first = piece
    folder = given.out / line
    folder.mkdir(exist_ok=True)
    seas = Plan.named("loads", PLAN_SEED, given.seas).seas
    mine = range(first, min(first + AT_ONCE // given.times, given.seas))
    rows = [row for row in mine if not (folder / f"sea-{row}.npz").exists()]
    if not rows:
        return
    history = simulate(
        cage,
        [seas[row] for row in rows for _ in range(given.times)],
        duration=given.duration,
        spin_up=given.spin_up,
        seed=[WAVE_SEED + row * given.times + time for row in rows for time in range(given.times)],
        sample_every=EVERY,
        series_nodes=[],
        parted=[line],
    )
    collar = history.node.mean[:, : cage.spokes, :2].mean(axis=1)
    for place, row in enumerate(rows):
        times = slice(place * given.times, (place + 1) * given.times)
        np.savez(
            folder / f"sea-{row}.npz",
            answered=has_answer(history.result[times]).all(),
            mean=history.lines.tension.mean[times].mean(axis=0),
            maximum_3h=extremes(list(history.line_tension[times]), every=EVERY).expected,
            largest=history.lines.tension.maximum[times].max(axis=0),
            volume=history.volume.mean[times].mean() / cage.volume(cage.design_position),
            drift=np.linalg.norm(collar[times].mean(axis=0)),
        )
    print(f"without {line}: sea {rows[-1] + 1} of {given.seas}", flush=True)


def _report(found: IfParted, folder: Path) -> None:
    seas = [np.load(folder / f"sea-{row}.npz") for row in range(len(found.reason))]
    true = {name: np.stack([one[name] for one in seas]) for name in seas[0]}
    maximum = np.where(np.isfinite(true["maximum_3h"]), true["maximum_3h"], true["largest"])
    counts = true["answered"] & found.in_domain[:, 0]
    print(f"  {counts.sum()} of {len(seas)} seas ended with an answer and are in the domain")
    kinds = np.array(found.line_kinds)
    for name, load, told in (
        ("mean", true["mean"], found.mean[:, 0]),
        ("3 h maximum", maximum, found.maximum_3h[:, 0]),
    ):
        for what, some in (("any line", kinds != "buoy line"), ("bridle", kinds == "bridle")):
            mine, reference = told[counts][:, some], load[counts][:, some]
            most = reference.max(axis=1)
            error = np.abs(mine.max(axis=1) / most - 1.0)
            named = reference[np.arange(len(most)), mine.argmax(axis=1)] / most
            print(
                f"  largest {name}, {what}: error median {np.median(error):.2%}, 90 % "
                f"{np.quantile(error, 0.9):.1%}; the line named carries 95 % of it in "
                f"{np.mean(named >= NAMED_CARRIES):.0%}"
            )
    for name, answer in (("volume", found.volume_share), ("drift", found.drift)):
        off = np.abs(answer[counts, 0] - true[name][counts])
        print(f"  {name}: error median {np.median(off):.3f}, 90 % {np.quantile(off, 0.9):.3f}")


if __name__ == "__main__":
    main()
