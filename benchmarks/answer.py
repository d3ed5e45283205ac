"""From a buoy's word to loads, shape and spread: the twin's answer against the simulator's.

The twin learns a formula here, as what it has learned does not change how long it takes.
"""

from itertools import islice

from _timing import ONCE, seconds, tell

from seacage.cage import Cage
from seacage.dynamics import settle
from seacage.ocean import SeaState
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas
from seacage.twin import Training, replay, train

cage = Cage.named("ace")
campaign = stand_in_campaign(cage, stand_in_seas(40 if ONCE else 300))
training = Training(high_fidelity_points=40 if ONCE else 200, days=2.0, restarts=0)
field = stand_in_field(cage)
twin = train(cage, campaign, field, training=training)
sea = SeaState(current_speed=0.5, current_to=40.0)
rows = 4 if ONCE else 256
samples = list(islice(field.buoy.samples(), rows))

tell(
    "answer, per sea state",
    {
        "twin, one at a time": seconds(lambda: twin.predict(sea)),
        "twin, many together": seconds(lambda: twin.predict([sea] * rows)) / rows,
        "twin, sample by sample in a replay": seconds(lambda: list(replay(twin, samples)), rounds=2)
        / rows,
        "simulator, one at a time": seconds(lambda: settle(cage, sea)),
    },
)
