"""What three virtual fields say of the rules that keep them honest: the fidelity study's claims.

    python tools/three_fields.py OUT                    settled, 48 days each, some minutes
    python tools/three_fields.py OUT --seeds 0,1,2

Each seed draws another true cage from the ranges of the hidden parameters, and other weather.
Ends with 1 where a rule is broken: the low fidelity has to underestimate all three depths and the
mean tension of the bridles with shackles, the best rescaling to leave a tenth of its error at
every sensor, and multifidelity to gain nothing where the truth is the low fidelity itself.
"""

import argparse
import sys
from pathlib import Path

from seacage.campaigns import TruthParameters
from seacage.studies import fidelity_study

RULES = 4
"""Of the study's claims, the first ones."""


def main() -> None:
    """Print each seed's claims, and the shares that rescaling leaves."""
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("out", type=Path, help="folder of the studies; goes on where it was")
    options.add_argument("--seeds", default="0,1,2")
    options.add_argument("--workers", type=int)
    given = options.parse_args()
    broken = 0
    for seed in map(int, given.seeds.split(",")):
        hidden = TruthParameters.read().drawn(seed)
        out = given.out / f"seed-{seed}"
        study = fidelity_study(out, hidden=hidden, seed=seed, workers=given.workers)
        print(f"seed {seed}, hidden parameters {hidden.sha256[:10]} (virtual field)")
        for number, claim in enumerate(study.claims):
            broken += number < RULES and not claim.holds
            print(f"  {claim.verdict}: {claim.claim} {claim.finding}")
        for gap, left in zip(study.gaps, study.rescalings, strict=True):
            print(
                f"  {gap.sensor}: truth {gap.truth:.2f} {gap.unit}, low {gap.low:.2f}, MAE "
                f"{gap.mae:.2f}, left by rescaling {left.left:.0%}",
                flush=True,
            )
    sys.exit(broken > 0)


if __name__ == "__main__":
    main()
