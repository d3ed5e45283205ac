"""How far an ROV is from the net, how surely, and a way along the net to inspect it.

python examples/09_clearance.py
"""

import tempfile
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import Plan, TruthParameters, run_campaign, true_shapes
from seacage.ocean import SeaState
from seacage.studies import learned_discrepancy, score_points
from seacage.twin import PredictedNet, Training, inspection_path, train

# A coarse net and few simulations, for quickness: some ten seconds on one core.
cage = Cage.named("ace").altered(mesh={"spokes": 8})
plan = Plan.sample(0, 60, hs=(0.0, 0.0))
with tempfile.TemporaryDirectory() as name:
    campaign = run_campaign(cage, plan, Path(name) / "campaign.zarr", method="settle")
twin = train(cage, campaign, training=Training(restarts=0))

# How far true nets are from the twin's shapes: learned on a virtual field, 80 times of it.
twin = replace(twin, discrepancy=learned_discrepancy(twin, seeds=(0, 1), cases=40))

now = SeaState(current_speed=0.4, current_to=60.0)
net = PredictedNet.under(twin, now, t=datetime.now(UTC))

points = np.array([[0.0, 0.0, -5.0], [18.0, 0.0, -8.0], [30.0, 0.0, -8.0]])
clearance = net.clearance(points)
print("east, north, up | predicted | expected true net | nearer than 1 m")
for point, distance, expected, sigma, p in zip(
    points,
    clearance.distance,
    clearance.expected,
    clearance.sigma,
    clearance.p_below,
    strict=True,
):
    print(f"{point} | {distance:5.2f} m | {expected:5.2f} ± {sigma:.2f} m | {p:.3f}")

path = net.along(np.array([[0.0, 0.0, -5.0], [15.0, 5.0, -8.0], [15.0, -5.0, -8.0]]))
print(f"a path of {path.along[-1]:.0f} m is nearest after {path.along[path.closest]:.1f} m,")
print(f"by {path.clearance.distance[path.closest]:.2f} m; nearer than 1 m with {path.p_below:.3f}")

way = inspection_path(net, stand_off=2.0, side="inside", row_spacing=3.0, step=2.0)
print(f"inspection: {len(way)} waypoints, the first looking {way.heading[0]:.0f} degrees")

# The probabilities scored on days that they were not trained on.
scored = score_points(twin, true_shapes(cage, hidden=TruthParameters.read(), seeds=(9,), cases=20))
print("virtual field: points, foretold, happened")
for count, foretold, happened in scored.table(bins=5):
    print(f"{count:6d}  {foretold:.2f}  {happened:.2f}")
