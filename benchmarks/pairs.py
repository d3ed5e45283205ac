"""Pairs of published problem and size, seed by seed: goes on where the tables of scores stop.

``python benchmarks/pairs.py --seeds 1001-1030 --peers .venv-peers`` completes ``pairs.csv`` beside
this file, and ``peers/emukit_pairs.csv``, one seed after the other; a stop loses one
method's answers to one seed. Then it prints what the tables say of the seeds that are whole.
Without --peers Emukit's table stays as it is. After a change of a learner take its rows out of the
table, and they are made again.
"""

import argparse
import csv
import resource
from pathlib import Path
from tempfile import TemporaryDirectory

from _pairs import (
    EMUKIT_TABLE,
    OUR_TABLE,
    pair_problems,
    pair_scores,
    pair_verdicts,
    ratio_text,
    read_scores,
)
from _timing import ONCE

from seacage.studies._benchmarks._methods import EMUKIT, Method, own_methods, peer_methods
from seacage.studies._benchmarks._runs import Runs
from seacage.studies._text import number, percent

query = argparse.ArgumentParser()
query.add_argument("--seeds", default="1001-1030")
query.add_argument("--peers", type=Path)
query.add_argument("--minutes", type=float, default=1e9, help="of a core; no seed begins later")
query.add_argument("--once", action="store_true")
options = query.parse_args()


def spent() -> float:
    """Time of the processor that finished answers took [min]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (used.ru_utime + used.ru_stime) / 60.0


def complete(method: Method, seed: int, runs: Runs) -> None:
    """Append what a table lacks of a method and a seed."""
    table = EMUKIT_TABLE if method.name == EMUKIT else OUR_TABLE
    there = {(one.method, one.problem, one.seed) for one in read_scores(table)}
    missing = [
        (problem, seed)
        for problem in pair_problems(method)
        if (method.name, problem.name, seed) not in there
    ]
    scores = runs.ensure(missing, method, on_done=lambda _: None) if missing else []
    with table.open("a", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        for one in scores:
            if one.error:
                print(f"{one.method}, {one.problem}, seed {one.seed}: {one.error}", flush=True)
            numbers = (f"{one.rmse:.4g}", f"{one.coverage:.4g}")
            writer.writerow((one.method, one.problem, one.seed, *numbers))


def print_report() -> None:
    """Print a table of Markdown, and the verdicts."""
    scores = [one for table in (OUR_TABLE, EMUKIT_TABLE) for one in read_scores(table)]
    pairs = pair_scores(scores)
    print(
        "| pair | best single | average | NARGP | over the best | over Emukit | coverage | AR(1) |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for one in pairs:
        shares = (percent(one.coverage, digits=1), percent(one.coverage_in_time, digits=1))
        ratios = (number(one.ratio), number(one.nargp_ratio))
        over = (ratio_text(one.over_best), ratio_text(one.over_emukit))
        print(f"| {' | '.join((one.title, one.best, *ratios, *over, *shares))} |")
    with EMUKIT_TABLE.open(encoding="utf-8") as file:
        print(f"\n{pairs[0].seeds} seeds; Emukit's are kept: {file.readline().strip('# ')}")
    for claim in pair_verdicts(pairs):
        print(f"| {claim.claim} | {claim.verdict} | {claim.finding} |")


def main() -> None:
    first, last = map(int, options.seeds.split("-"))
    methods = list(own_methods())
    if options.peers:
        methods += [one for one in peer_methods(options.peers) if one.name == EMUKIT]
    for seed in range(first, last + 1):
        if spent() > options.minutes:
            break
        for method in methods:
            with TemporaryDirectory() as folder:
                complete(method, seed, Runs(folder=Path(folder)))
            print(f"seed {seed} {method.name}: {spent():.1f} min of a core in all", flush=True)


if not ONCE:
    main()
print_report()
