"""A campaign's own path, from sea states to statistics on disk: simulated time per core time."""

import tempfile
import time
from pathlib import Path

from _timing import ONCE

from seacage.cage import Cage
from seacage.campaigns import Plan, campaign_status, run_campaign
from seacage.dynamics import rest_shape

SEED = 1
CAGE = Cage.named("ace")
PUBLISHED = {
    "FhSim, 10 minutes of wall time on 56 cores for 1,800 s": 1800.0 / (600.0 * 56.0),
    "FhSim, if its 10 minutes are of all cores together": 1800.0 / 600.0,
}
"""Simulated seconds per core-second, as Katsidoniotaki et al. can be read in two ways."""


def campaign(cases: int, duration: float, spin_up: float) -> None:
    rest_shape(CAGE)  # once for any number of cases, so not counted
    plan = Plan.named("paper", SEED, cases, duration=duration)
    with tempfile.TemporaryDirectory() as folder:
        store = Path(folder, "paper.zarr")
        began = time.process_time()
        run_campaign(CAGE, plan, store, workers=1, ramp=min(60.0, spin_up), spin_up=spin_up)
        core = time.process_time() - began
        reached = campaign_status(store)
        size = sum(file.stat().st_size for file in store.rglob("*") if file.is_file())
    print(f"campaign, {cases} cases of plan paper, {duration:g} s and {spin_up:g} s of spin-up")
    print(f"  {reached.converged} converged, {size / 1e6:.1f} MB on disk")
    print(f"  {core:.1f} core-seconds, {1.0 - reached.core_seconds / core:.1%} of them to write")
    pace = reached.simulated_s / core
    print(f"  {pace:.0f} simulated seconds per core-second, spin-up and writing counted")
    counted = cases * duration / core
    print(f"  {counted:.0f} without the spin-up's seconds")
    for name, theirs in PUBLISHED.items():
        print(f"  {counted / theirs:.0f} × {name}: {theirs:.2g}")


campaign(2 if ONCE else 32, 5.0 if ONCE else 1800.0, 5.0 if ONCE else 300.0)
