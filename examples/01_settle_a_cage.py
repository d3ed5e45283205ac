"""Settle the reference cage in a current and draw it: the picture of the README.

python examples/01_settle_a_cage.py docs/pictures/ace.png
"""

import sys
from pathlib import Path

from seacage.cage import Cage
from seacage.dynamics import rest_shape, settle
from seacage.figures import net_figure, write_figure
from seacage.ocean import SeaState

cage = Cage.named("ace")
sea = SeaState(current_speed=0.5, current_to=40.0)
answer = settle(cage, sea)

print(f"The fullest bridle carries {answer.bridle_tension.max() / 1e3:.1f} kN.")
print(f"The net keeps {100 * answer.volume_fraction:.0f} % of its volume.")
print(f"Its tip is lifted {answer.node_displacement[cage.bottom_node, 2]:.1f} m.")

figure = net_figure(
    cage,
    answer.node_position,
    rest_position=rest_shape(cage),
    bridle_tension=answer.bridle_tension,
    sea=sea,
)
write_figure(figure, Path(sys.argv[1] if len(sys.argv) > 1 else "ace.png"))
