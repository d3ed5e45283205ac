"""How far points are from the net: the pruned search against every triangle for every point.

The net is the reference cage's in half a metre of current per second, two triangles to a panel
and one to each panel of the cone's last ring; half of the points lie within a few metres of it.
"""

import numpy as np
from _timing import ONCE, print_times, seconds

from seacage.cage import Cage
from seacage.cage._nearest import _Surface, _Touch, _triangles
from seacage.dynamics import settle
from seacage.ocean import SeaState

cage = Cage.named("ace")
shape = settle(cage, SeaState(current_speed=0.5, current_to=90.0)).node_position
count = 20 if ONCE else 1000
random = np.random.default_rng(0)
around = random.uniform([-30.0, -30.0, -35.0], [30.0, 30.0, 0.0], (count // 2, 3))
close = shape[random.integers(len(shape), size=count // 2)] + random.normal(size=(count // 2, 3))
points = np.concatenate([around, close])
surface = _Surface.of(shape, _triangles(cage.panels))
every = np.arange(len(surface.corner))


def brute() -> np.ndarray:
    """Check every pair exactly, a hundred points at a time as memory goes."""
    parts = np.array_split(points, max(1, count // 100))
    return np.concatenate([_least(part) for part in parts])


def _least(part: np.ndarray) -> np.ndarray:
    pairs = np.repeat(part, len(every), axis=0), np.tile(every, len(part))
    return _Touch.of(*pairs, surface).distance.reshape(len(part), -1).min(axis=1)


assert np.allclose(brute(), cage.nearest(points, shape).distance, atol=1e-6)
print_times(
    f"clearance, {count} points and {len(every)} triangles",
    {
        "pruned, many points together": seconds(lambda: cage.nearest(points, shape)),
        "every triangle for every point": seconds(brute, rounds=1),
        "pruned, one point": seconds(lambda: cage.nearest(points[:1], shape)),
    },
)
