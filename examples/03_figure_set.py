"""Draw the cage at five currents, what its bridles carry in waves, and the volume that it keeps.

python examples/03_figure_set.py docs/pictures
"""

import sys
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.dynamics import rest_shape, settle, simulate
from seacage.figures import states_figure, tension_rose_figure, volume_figure, write_figure
from seacage.ocean import SeaState

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600.0
spin_up = min(300.0, seconds)

cage = Cage.named("ace")
current_to = 20.0

# From the side and from above, at rest in five currents.
speed = np.linspace(0.0, 1.0, 5)
settled = settle(cage, [SeaState(current_speed=v, current_to=current_to) for v in speed])
figure = states_figure(
    cage,
    speed,
    settled.node_position,
    current_to=current_to,
    rest_position=rest_shape(cage),
)
write_figure(figure, folder / "states.png")

# What each bridle carries in the same currents with waves of 2 m along them: mean and range.
seas = [
    SeaState(current_speed=v, current_to=current_to, hs=2.0, tp=7.5, wave_from=current_to + 180.0)
    for v in speed
]
moving = simulate(
    cage, seas, duration=seconds, spin_up=spin_up, ramp=min(60.0, spin_up), sample_every=None
)
figure = tension_rose_figure(
    cage,
    speed,
    moving.bridle.mean,
    current_to=current_to,
    lowest=moving.bridle.minimum,
    highest=moving.bridle.maximum,
)
write_figure(figure, folder / "rose.png")

# The volume by three load laws, beside what was measured on other cages.
speed = np.linspace(0.0, 1.0, 21)
laws = {
    "Kristiansen & Faltinsen": "kristiansen-faltinsen",
    "Løland": "loland",
    "Aarsnes": "aarsnes",
}
seas = [SeaState(current_speed=v, current_to=current_to) for v in speed]
fraction = {name: settle(cage, seas, law=law).volume_fraction for name, law in laws.items()}
write_figure(volume_figure(speed, fraction), folder / "volume.png")

for name in ("states.png", "rose.png", "volume.png"):
    print(folder / name)
