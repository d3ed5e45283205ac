"""Lines that have parted: settled, in time, and refused where there are none."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError, Result
from seacage.dynamics import settle, simulate
from seacage.ocean import SeaState

SMALL = Cage.named("ace").altered(mesh={"spokes": 12})
SEA = SeaState(current_speed=0.5, current_to=90.0)
GONE = 5


def test_a_parted_bridle_bears_nothing_and_its_neighbours_more():
    whole, parted = settle(SMALL, SEA), settle(SMALL, SEA, parted=["bridle-6"])
    assert parted.result == Result.CONVERGED
    assert parted.bridle_tension[GONE] < 1.0
    # 1.38 measured: a collar that is stiff in its plane hands the load on to bridles beyond, too
    assert parted.bridle_tension[GONE - 1] > 1.3 * whole.bridle_tension[GONE - 1]
    np.testing.assert_array_equal(
        settle(SMALL, SEA, parted=()).bridle_tension, whole.bridle_tension
    )


@pytest.mark.slow
def test_settled_and_simulated_without_waves_agree():
    still = settle(SMALL, SEA, parted=["bridle-6"]).bridle_tension
    moving = simulate(SMALL, SEA, duration=20.0, spin_up=140.0, parted=["bridle-6"])
    np.testing.assert_allclose(moving.bridle.mean, still, atol=60.0)


def test_a_whole_mooring_may_lose_a_frame_line_or_an_anchor_line():
    gone = ["frame-4", "anchor-3"]
    history = simulate(SMALL, SEA, duration=10.0, spin_up=60.0, parted=gone)
    assert history.result == Result.CONVERGED
    lost = np.isin(history.lines.names, gone)
    assert np.all(history.lines.tension.maximum[lost] < 10.0)
    assert np.all(history.lines.tension.mean[~lost] >= 0.0)


def test_a_corner_whose_buoy_is_gone_hangs_on_its_other_lines():
    whole, parted = settle(SMALL, SEA), settle(SMALL, SEA, parted=["buoy-2"])
    assert parted.result == Result.CONVERGED
    gone = np.array(parted.line_names) == "buoy-2"
    np.testing.assert_array_equal(parted.line_tension[gone], 0.0)
    share = (parted.line_tension[24:].sum() / whole.line_tension[24:][~gone[24:]].sum()).item()
    assert 0.7 < share < 1.0  # lines that no buoy holds up hang less on the other buoys, too
    moving = simulate(SMALL, SEA, duration=10.0, spin_up=60.0, parted=["buoy-2"])
    assert moving.result == Result.CONVERGED
    np.testing.assert_array_equal(moving.lines.tension.maximum[gone], 0.0)


@pytest.mark.parametrize("run", [settle, lambda *a, **k: simulate(*a, duration=1.0, **k)])
@pytest.mark.parametrize("name", ["bridle-99", "anchor-9", ""])
def test_a_line_that_does_not_exist_is_refused(run, name):
    with pytest.raises(InputError, match=f"parted = '{name}': there is no such line.*bridle-12"):
        run(SMALL, SEA, parted=[name])
