"""Equilibria of the reference cage: one current at a time against many side by side."""

from _timing import ONCE, seconds, tell

from seacage.cage import Cage
from seacage.campaigns import Plan
from seacage.dynamics import settle

cage = Cage.named("ace")
seas = Plan.sample(seed=0, cases=2 if ONCE else 16).seas

together = seconds(lambda: settle(cage, seas, mean_waves=True), rounds=2)
alone = seconds(lambda: [settle(cage, sea, mean_waves=True) for sea in seas], rounds=2)
tell(
    f"settle, per case of {len(seas)}",
    {"all together": together / len(seas), "one by one": alone / len(seas)},
)
