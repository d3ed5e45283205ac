"""How far level 1 of lines' loads in waves is from seas simulated at length.

    python tools/score_loads.py CAMPAIGN OUT [--seas 100] [--times 6] [--workers 2]

CAMPAIGN is one of ``seacage campaign run --plan loads``. Other seas of that plan are simulated,
each so many times for half an hour with other phases of the waves, and kept in OUT; stopped, it
goes on. The reference is all times of a sea together, and the largest of three hours the expected
one of their peaks. Computed, from the low fidelity's own simulations: nothing here is of a cage.
"""

import argparse
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

from seacage.cage import Cage, mooring_lines
from seacage.campaigns import Plan
from seacage.dynamics import extremes, simulate
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, read_campaign
from seacage.twin import Metocean
from seacage.twin._training._loads import train_line_loads

HALF_HOUR, SPIN_UP, EVERY = 1800.0, 300.0, 0.1
AT_ONCE = 8
"""Seas of a process's piece of work: with six times each they fill the lanes of any kernel."""
PLAN_SEED, WAVE_SEED = 101, 5000
LOADED = 1e3
"""Lines with a lower mean are scored apart from none [N]."""
STATISTICS = "mean", "std", "maximum_3h", "damage_equivalent"
DRAWS = 2000


def main() -> None:
    """Simulate what is missing, train, and print the scores."""
    options = argparse.ArgumentParser(description="Score level 1 of lines' loads in waves.")
    options.add_argument("campaign", type=Path)
    options.add_argument("out", type=Path)
    options.add_argument("--seas", type=int, default=100)
    options.add_argument("--times", type=int, default=6)
    options.add_argument("--workers", type=int, default=2)
    given = options.parse_args()
    campaign = read_campaign(given.campaign)
    cage = Cage.from_toml(campaign.cage_toml)
    seas = Plan.named("loads", PLAN_SEED, given.seas).seas
    given.out.mkdir(parents=True, exist_ok=True)
    pieces = range(0, len(seas), AT_ONCE)
    with ProcessPoolExecutor(given.workers) as pool:
        work = partial(_simulated, cage, seas, given.out, given.times)
        for done, _ in enumerate(pool.map(work, pieces), 1):
            print(f"{done} of {len(pieces)} pieces simulated", flush=True)
    kept = [np.load(given.out / f"sea-{row}.npz") for row in range(len(seas))]
    single = {name: np.stack([one[name] for one in kept]) for name in (*STATISTICS, "largest")}
    _report(cage, seas, campaign, single)


def _simulated(cage: Cage, seas: tuple[SeaState, ...], out: Path, times: int, first: int) -> None:
    piece = range(first, min(first + AT_ONCE, len(seas)))
    rows = [row for row in piece if not (out / f"sea-{row}.npz").exists()]
    if not rows:
        return
    history = simulate(
        cage,
        [seas[row] for row in rows for _ in range(times)],
        duration=HALF_HOUR,
        spin_up=SPIN_UP,
        seed=[WAVE_SEED + row * times + time for row in rows for time in range(times)],
        sample_every=EVERY,
        series_nodes=[],
    )
    for place, row in enumerate(rows):
        mine = slice(place * times, (place + 1) * times)
        if np.any(history.result[mine] != 0):
            print(f"sea {row} ended as {history.result[mine]}", flush=True)
        series = list(history.line_tension[mine])
        lines = history.lines
        np.savez(
            out / f"sea-{row}.npz",
            mean=lines.tension.mean[mine],
            std=lines.tension.std[mine],
            damage_equivalent=lines.damage_equivalent[mine],
            largest=lines.tension.maximum[mine],
            maximum_3h=extremes(series, every=EVERY).expected,
        )


def _report(
    cage: Cage,
    seas: tuple[SeaState, ...],
    campaign: CampaignRecord,
    single: Mapping[str, np.ndarray],
) -> None:
    loads = train_line_loads(cage, campaign, restarts=1, seed=0)
    if loads is None:
        raise SystemExit("The campaign teaches no loads in waves.")
    water = Metocean.of(seas)
    predicted, inside, _ = loads.predict(water)
    lines = mooring_lines(cage, anchored=True)
    columns = [lines.names.index(name) for name in loads.names]
    single = {name: one[..., columns] for name, one in single.items()}
    slope = lines.tn_slope[columns]
    reference = {
        "mean": single["mean"].mean(axis=1),
        "std": np.sqrt((single["std"] ** 2).mean(axis=1) + single["mean"].var(axis=1)),
        "maximum_3h": single["maximum_3h"],
        "damage_equivalent": (single["damage_equivalent"] ** slope).mean(axis=1) ** (1.0 / slope),
    }
    realised = {**single, "maximum_3h": single["largest"].max(axis=1, keepdims=True)}
    loaded = reference["mean"] > LOADED
    kinds = np.array(loads.kinds)
    print(f"{len(seas)} seas ({inside.sum()} inside the domain), {campaign.converged.sum()} cases")
    for name in STATISTICS:
        one = getattr(predicted, name)
        with np.errstate(divide="ignore", invalid="ignore"):  # a line that bears nothing
            error = np.abs(one.mean / reference[name] - 1.0)
        for kind in ("bridle", "anchor line"):
            of_kind = np.flatnonzero(kinds == kind)
            most = of_kind[np.nan_to_num(reference[name][:, of_kind]).argmax(axis=1)]
            _print_median(f"{name}, most loaded {kind}", error[np.arange(len(seas)), most])
        some = loaded & np.isfinite(error)
        print(
            f"{name}, all lines above 1 kN: median {np.median(error[some]):.2%}, "
            f"90 % {np.quantile(error[some], 0.9):.1%}"
        )
        lower, upper = one.interval(0.95)
        held = (realised[name] >= lower[:, None]) & (realised[name] <= upper[:, None])
        _print_coverage(name, held, some, reference[name])


def _print_median(what: str, error: np.ndarray) -> None:
    rng = np.random.default_rng(0)
    drawn = np.nanmedian(error[rng.integers(len(error), size=(DRAWS, len(error)))], axis=1)
    low, high = np.quantile(drawn, (0.025, 0.975))
    print(f"{what}: median {np.nanmedian(error):.2%} [{low:.2%}, {high:.2%}] by seas")


def _print_coverage(name: str, held: np.ndarray, some: np.ndarray, load: np.ndarray) -> None:
    share = held.mean(axis=1)
    third = np.quantile(load[some], (1 / 3, 2 / 3))
    parts = [
        share[some & (np.digitize(np.nan_to_num(load), third) == part)].mean() for part in range(3)
    ]
    every = share[np.isfinite(load)].mean()
    shown = ", ".join(f"{part:.0%}" for part in parts)
    seas = np.random.default_rng(0).integers(len(some), size=(DRAWS, len(some)))
    count, total = some.sum(axis=1), np.where(some, share, 0.0).sum(axis=1)
    low, high = np.quantile(total[seas].sum(axis=1) / count[seas].sum(axis=1), (0.025, 0.975))
    print(
        f"{name}: 95 % interval holds {share[some].mean():.1%} [{low:.1%}, {high:.1%}] by seas "
        f"(by thirds {shown}; all {every:.0%})"
    )


if __name__ == "__main__":
    main()
