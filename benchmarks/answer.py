"""From a buoy's word to loads, shape and spread: the twin's answer against the simulator's.

The twin learns a formula here, as what it has learned does not change how long it takes. Then
what level 2 costs: each sensor's NARGP after another, all of them together, and the triangular
systems in it alone, which is what no arrangement of the calls can save. Last, the loads of lines in
waves, in all images of 480 made-up cases: the means, and with their standard deviations.
"""

from collections.abc import Callable
from itertools import islice

import numpy as np
from _timing import ONCE, print_times, seconds

from seacage.cage import Cage
from seacage.dynamics import settle
from seacage.ocean import SeaState
from seacage.surrogates import LoadCases, LoadGP, Prediction, Symmetry, sea_features
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas
from seacage.twin import Metocean, Models, Training, replay, train

TIMES = 1 if ONCE else 200
"""That a short work is done for one measurement."""

cage = Cage.named("ace")
campaign = stand_in_campaign(cage, stand_in_seas(40 if ONCE else 300))
training = Training(high_fidelity_points=40 if ONCE else 200, days=2.0, restarts=0)
field = stand_in_field(cage)
twin = train(cage, campaign, field, training=training)
sea = SeaState(current_speed=0.5, current_to=40.0)
rows = 4 if ONCE else 256
samples = list(islice(field.buoy.samples(), rows))


def each(work: Callable[[], object]) -> float:
    """Time of a short work [s]."""
    return seconds(lambda: [work() for _ in range(TIMES)]) / TIMES


def level_two(models: Models) -> dict[str, float]:
    """What level 2 of all sensors takes for one sea state, asked in several ways [s]."""
    assert models.together is not None
    level, x = models.together.rest, Metocean.of(sea).features(models.inputs)
    names = twin.sensor_names
    columns = [column for column, name in enumerate(names) if name in models.upper]
    predicted = twin.predict(sea).sensor_low
    low = Prediction(mean=predicted.mean[:, columns], std=predicted.std[:, columns])
    alone = [
        (models.upper[names[column]].rest, Prediction(mean=m, std=s))
        for column, m, s in zip(columns, low.mean.T, low.std.T, strict=True)
    ]
    systems = [(one.factor, np.ones((3, len(one.x)))) for one in level.members]
    return {
        "one sensor after another": each(
            lambda: [one.predict(x, below=below) for one, below in alone]
        ),
        "all together": each(lambda: level.predict(x, low)),
        "their triangular systems alone": each(
            lambda: [factor.variance_reduction(right) for factor, right in systems]
        ),
    }


def line_loads(count: int) -> dict[str, float]:
    """What the loads of four lines take for one sea state, learned from a formula [s]."""
    places = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    random = np.random.default_rng(1)
    angle, hs = random.uniform(0.0, 2.0 * np.pi, (count, 2, 1)), random.uniform(0.2, 3.0, count)
    current, wave = np.concatenate([np.cos(angle), np.sin(angle)], axis=2).swapaxes(0, 1)
    period = 5.0 * np.sqrt(hs) * random.uniform(0.8, 2.5, count)
    x = sea_features(
        random.uniform(0.1, 1.0, (count, 1)) * current, hs=hs, tp=period, wave_direction=wave
    )
    mean = 1e4 + 5e3 * x[:, 1:3] @ places[:, :2].T
    std = 1e3 * hs[:, None] * np.exp(0.03 * random.standard_normal((count, 4)))
    cases = LoadCases(
        mean=mean,
        std=std,
        most_probable=mean + 3.0 * std,
        expected=mean + 3.2 * std,
        largest=mean + 3.0 * std,
        damage_equivalent=2.0 * std,
    )
    symmetry = Symmetry.of(places, fold=4, mirror=0.0)
    model = LoadGP(symmetry=symmetry, restarts=0).fit(x, cases, duration=600.0)
    one = x[:1]
    return {
        "means": each(lambda: model.predict(one, spread=False)),
        "with standard deviations": each(lambda: model.predict(one)),
    }


print_times(
    "answer, per sea state",
    {
        "twin, one at a time": each(lambda: twin.predict(sea)),
        "twin, many together": seconds(lambda: twin.predict([sea] * rows)) / rows,
        "twin, sample by sample in a replay": seconds(lambda: list(replay(twin, samples)), rounds=2)
        / rows,
        "simulator, one at a time": seconds(lambda: settle(cage, sea)),
    },
)
print_times("level 2 of eight sensors, per sea state", level_two(twin.models))
print_times("loads of lines, per sea state", line_loads(24 if ONCE else 480))
