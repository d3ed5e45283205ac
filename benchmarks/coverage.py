"""Do the twin's intervals hold the truth? Virtual fields, on days that did not teach.

Each seed draws its own current, noise and outages; the hidden cage is the same in all. Level 1 is
trained once. The interval is that of what lies behind a reading. A file of JSON for each seed goes
to the folder named by --out, so that a stop loses one seed at most; finished seeds are only read.
The reported figures are of `--seeds 0 1 2 3 4 5 6 7 8 9`; without it seed 0 alone is measured.

Beside the twin stand two NARGPs alone on the same points: plain NARGP, which has the kernel as
published, and ours as it comes.
"""

import argparse
import json
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from _coverage import truth_coverage

from seacage.cage import Cage
from seacage.studies._chain import Chain, Recipe
from seacage.studies._split import split
from seacage.testing import stand_in_twin
from seacage.twin import Training, Twin, train

query = argparse.ArgumentParser()
query.add_argument("--once", action="store_true")
query.add_argument("--seeds", type=int, nargs="+", default=[0])
query.add_argument("--restarts", type=int, default=3)
query.add_argument("--out", type=Path)
query.add_argument("--fields", type=Path, help="folder of made fields, field-<seed>, else made")
arguments = query.parse_args()


def measured(seed: int, base: Twin, out: Path) -> dict:
    """One seed: its field, the twin of it, and how it held the truth."""
    from seacage.records import FieldRecord

    recipe = Recipe(seed=seed)
    if arguments.fields:
        folder = arguments.fields / f"field-{seed}"
        field, truth = FieldRecord.read(folder), FieldRecord.read(folder / "truth")
    else:
        chain = Chain(folder=out / "stages", cage=base.cage, recipe=recipe, workers=1)
        field, truth = chain.field, chain.truth
    teaching, _ = split(field, teaching_days=recipe.teaching_days)
    training = Training(days=float(recipe.teaching_days), seed=seed, restarts=arguments.restarts)
    twin = train(base.cage, None, teaching, base=base, training=training)
    scores = truth_coverage(
        twin, field, truth, training=training, since_day=float(recipe.teaching_days)
    )
    return {"seed": seed, "sensors": [asdict(score) for score in scores]}


def pooled(results: list[dict], sensors: str, kind: str) -> str:
    """The mean over sensors and seeds of one kind of interval."""
    rows = [
        one for result in results for one in result["sensors"] if one["sensor"].startswith(sensors)
    ]
    rows = [one for one in rows if one[kind] is not None]
    if not rows:
        return "none"
    thirds = np.mean([one[kind]["thirds"] for one in rows], axis=0)
    beside = "same_hours" if kind == "online" else "offline"
    ratio = {
        alone: np.mean([one[kind]["crps"] / one[alone]["crps"] for one in rows])
        for alone in ("published", "published_noisy", "plain", "plain_noisy")
    }
    per_seed = [
        np.mean(
            [
                one[kind]["overall"]
                for one in result["sensors"]
                if one[kind] is not None and one["sensor"].startswith(sensors)
            ]
        )
        for result in results
    ]
    worst = f"{min(per_seed):.3f} to {max(per_seed):.3f} by seed"
    text = f"{np.mean([one[kind]['overall'] for one in rows]):.3f} ({worst}), thirds "
    text += " ".join(f"{third:.3f}" for third in thirds)
    if kind == "offline":
        text += (
            f"; CRPS {ratio['published']:.3f} of plain NARGP's, {ratio['published_noisy']:.3f} "
            f"with its noise, {ratio['plain']:.3f} and {ratio['plain_noisy']:.3f} of ours alone"
        )
    elif kind == "online":
        against = np.mean([one["online"]["crps"] / one[beside]["crps"] for one in rows])
        text += f"; CRPS {against:.3f} of offline's in the same hours"
    return text


def print_table(results: list[dict]) -> None:
    """Print the table."""
    print(f"95 % intervals against the truth, virtual field, {len(results)} seeds")
    kinds = {
        "offline": "offline",
        "same_hours": "in labelled hours",
        "online": "online",
        "published": "plain NARGP",
        "published_noisy": "with its noise",
        "plain": "our NARGP alone",
        "plain_noisy": "with its noise",
    }
    for sensors in ("depth", "shackle"):
        for kind, title in kinds.items():
            print(f"  {sensors:<8} {title:<18} {pooled(results, sensors, kind)}")
    names = [one["sensor"] for one in results[0]["sensors"]]
    for name in names:
        rows = [one for result in results for one in result["sensors"] if one["sensor"] == name]
        low, multi = (np.mean([one[key] for one in rows]) for key in ("low_mae", "multi_mae"))
        covered = np.mean([one["offline"]["overall"] for one in rows])
        print(
            f"  {name:<12} MAE {multi:10.3f} of low fidelity's {low:10.3f}: "
            f"{multi / low:.2f}; offline {covered:.3f}"
        )


def main() -> None:
    with TemporaryDirectory() as temporary:
        out = arguments.out or Path(temporary)
        out.mkdir(parents=True, exist_ok=True)
        if (out / "base").exists():
            base = Twin.read(out / "base")
        else:
            chain = Chain(folder=out / "stages", cage=Cage.named("ace"), recipe=Recipe(), workers=1)
            base = train(chain.cage, chain.campaign)
            base.write(out / "base")
        results = []
        for seed in arguments.seeds:
            path = out / f"seed-{seed}.json"
            if not path.exists():
                path.write_text(json.dumps(measured(seed, base, out)) + "\n")
            results.append(json.loads(path.read_text()))
            print(f"seed {seed} done", flush=True)
        print_table(results)


def once() -> None:
    """Every line of the scoring, on a stand-in whose record is its own truth."""
    from seacage.testing import stand_in_field

    twin = stand_in_twin()
    field = stand_in_field(twin.cage)
    training = Training(high_fidelity_points=60, days=2.0, restarts=0)
    scores = truth_coverage(twin, field, field, training=training, since_day=2.0)
    print_table([{"seed": 0, "sensors": [asdict(score) for score in scores]}])


once() if arguments.once else main()
