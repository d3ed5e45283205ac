from dataclasses import replace

import numpy as np
import pytest

from benchmarks._coverage import held, truth_coverage
from seacage.conventions import InputError
from seacage.surrogates import crps
from seacage.testing import stand_in_field, stand_in_twin
from seacage.twin import Training

TRAINING = Training(high_fidelity_points=60, days=2.0, restarts=0)


def test_shares_are_of_all_and_of_each_third_of_the_load():
    truth = np.arange(300.0)
    std = np.where(truth < 100.0, 0.1, 10.0)
    scored = held(truth, truth + 1.0, std)
    assert scored.thirds == (0.0, 1.0, 1.0)
    assert scored.overall == pytest.approx(2 / 3)
    assert scored.crps == pytest.approx(crps(truth, truth + 1.0, std))


NAMES = ("depth-3", "shackle-1")


def averaged(fields):
    """Sensors whose noise is nearly gone."""
    first, sensors = fields[0], {}
    for name in NAMES:
        ((key, _),) = first.sensors[name].values.items()
        mean = np.mean([one.sensors[name].values[key] for one in fields], axis=0)
        sensors[name] = replace(first.sensors[name], values={key: mean})
    return replace(first, sensors=sensors)


def scores():
    twin = stand_in_twin()
    fields = [stand_in_field(twin.cage, seed=seed) for seed in range(12)]
    models = replace(twin.models, upper={name: twin.models.upper[name] for name in NAMES})
    return truth_coverage(
        replace(twin, models=models),
        fields[0],
        averaged(fields),
        training=TRAINING,
        since_day=2.0,
    )


@pytest.mark.slow
def test_a_twin_is_held_against_the_truth_offline_and_online_and_against_nargp_alone():
    depth, shackle = scores()
    for score in (depth, shackle):
        assert score.multi_mae < 0.4 * score.low_mae
        # One tide taught, another judges: the share moves from tide to tide.
        assert score.offline.overall > 0.7
        assert score.plain_noisy.overall >= score.plain.overall
    # The shackle speaks on the last day alone, the depth sensor on both.
    assert depth.offline.count == pytest.approx(2 * 720, abs=5)
    assert depth.online.count == depth.offline.count
    assert shackle.online.count == pytest.approx(720, abs=5)


def test_a_record_without_unseen_days_is_refused():
    twin = stand_in_twin()
    field = stand_in_field(twin.cage, days=1.0)
    with pytest.raises(InputError, match="too few to judge by"):
        truth_coverage(twin, field, field, training=TRAINING, since_day=2.0)
