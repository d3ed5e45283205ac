"""Simulate the reference cage in waves and draw it moving: the animation of the README.

python examples/02_simulate_a_cage.py docs/pictures/waves.gif
"""

import sys
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.dynamics import rest_shape, simulate
from seacage.figures import Motion, write_animation
from seacage.ocean import SeaState, Waves, spectrum, wavenumber

path = Path(sys.argv[1] if len(sys.argv) > 1 else "waves.gif")
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 60.0

cage = Cage.named("ace")
sea = SeaState(current_speed=0.5, current_to=70.0, hs=2.5, tp=7.5, wave_from=235.0)

# A sea that repeats when the animation does, so that the loop closes: every wave fits into it a
# whole number of times. `simulate` alone would draw waves that do not repeat.
omega = 2.0 * np.pi / seconds
number = np.arange(np.ceil(0.5 * seconds / sea.peak_period), 3.0 * seconds / sea.peak_period)
amplitude = np.sqrt(2.0 * omega * spectrum(sea, omega * number))
waves = Waves(
    amplitude=amplitude,
    angular_frequency=omega * number,
    wavenumber=wavenumber(omega * number, depth=cage.site.water_depth),
    phase=np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, number.size),
    direction=np.tile(sea.wave_direction, (number.size, 1)),
    depth=cage.site.water_depth,
)

spin_up = 3.0 * seconds
answer = simulate(
    cage, sea, waves=waves, duration=seconds, spin_up=spin_up, ramp=seconds, sample_every=0.1
)
fullest = int(answer.bridle.mean.argmax())
print(f"{cage.bridle_names[fullest]} carries {answer.bridle.mean[fullest] / 1e3:.0f} kN on average")
print(f"and {answer.bridle.maximum[fullest] / 1e3:.0f} kN at most.")
print(f"The net keeps {100 * answer.volume_fraction:.0f} % of its volume on average.")

motion = Motion(
    time=spin_up + answer.time,
    node_position=answer.node_position,
    bridle_tension=answer.bridle_tension,
    rest_position=rest_shape(cage),
    sea=sea,
    waves=waves,
)
write_animation(path, cage, motion)
