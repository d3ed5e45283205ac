from dataclasses import replace

import numpy as np
import pytest

from predicted_nets import CAGE, erring_twin, level_1_twin, net_in
from seacage.conventions import InputError, ModelError, Origin
from seacage.testing import stand_in_twin
from seacage.twin import Discrepancy, Twin
from seacage.twin._discrepancy import ShapeError


def known(velocity, drift) -> Discrepancy:
    """Return what is learned from nets that drift as wholes, each by its own vector."""
    velocity, drift = np.array(velocity, dtype=float), np.array(drift, dtype=float)
    predicted = np.broadcast_to(CAGE.design_position, (len(velocity), CAGE.node_count, 3))
    return Discrepancy.fit(
        CAGE,
        velocity,
        predicted=predicted,
        true=predicted + drift[:, None],
        origin=Origin.VIRTUAL_FIELD,
    )


def test_a_net_that_always_drifts_alike_is_expected_there_and_nowhere_else():
    error = known([[0.5, 0.0], [0.5, 0.0]], [[1.0, 2.0, 3.0]] * 2).at(CAGE, np.array([0.5, 0.0]))
    np.testing.assert_allclose(error.shift, np.tile([1.0, 2.0, 3.0], (CAGE.node_count, 1)))
    near = CAGE.nearest(np.array([[0.0, 0.0, -5.0]]), CAGE.design_position)
    np.testing.assert_allclose(error.displacement(near), 0.0, atol=1e-12)
    assert error.scatter(near, np.full(CAGE.node_count, 0.2)) == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("velocity", "drift"),
    [
        ([0.8, 0.0], 1.0),
        ([0.0, 0.8], 2.0),
        ([0.2, 0.0], 3.0),
        ([5.0, 0.0], 1.0),  # faster than any that was met
    ],
)
def test_the_cases_whose_currents_were_alike_speak(velocity, drift):
    one = known([[0.8, 0.0], [0.0, 0.8], [0.2, 0.0]], [[1.0, 0, 0], [2.0, 0, 0], [3.0, 0, 0]])
    error = one.at(CAGE, np.array(velocity))
    assert error.mean[0, 0] == pytest.approx(drift, abs=0.05)
    assert error.weight.sum() == pytest.approx(1.0)


def test_in_slack_water_no_direction_counts():
    one = known([[0.0, 0.0], [0.01, 0.0], [0.0, -0.01]], [[1.0, 0, 0], [2.0, 0, 0], [3.0, 0, 0]])
    error = one.at(CAGE, np.zeros(2))
    np.testing.assert_allclose(error.weight, 1.0 / 3.0, rtol=0.02)


def test_an_outward_drift_takes_the_net_outwards_on_one_side_and_inwards_on_the_other():
    one = known([[0.5, 0.0]] * 2, [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    error = one.at(CAGE, np.array([0.5, 0.0]))
    sides = np.array([[20.0, 0.0, -5.0], [-20.0, 0.0, -5.0]])
    displacement = error.displacement(CAGE.nearest(sides, CAGE.design_position))
    # Of eight spokes the panels beside the east lie askew, by the cosine of 22.5 degrees.
    np.testing.assert_allclose(displacement, [[0.92, -0.92], [-0.92, 0.92]], atol=0.01)


def test_a_twins_known_error_is_saved_with_it_and_an_older_twin_has_none(tmp_path):
    twin = erring_twin(cases=30)
    twin.write(tmp_path / "twin")
    was, now = twin.discrepancy, Twin.read(tmp_path / "twin").discrepancy
    assert was is not None
    assert now is not None
    assert now.origin == "virtual field"
    for key in ("current_velocity", "ring", "rest"):
        np.testing.assert_array_equal(getattr(now, key), getattr(was, key))
    stand_in_twin().write(tmp_path / "older")
    assert Twin.read(tmp_path / "older").discrepancy is None


def test_a_known_error_of_another_mesh_is_refused(tmp_path):
    twin = erring_twin(cases=10)
    assert twin.discrepancy is not None
    ring, rest = twin.discrepancy.ring[:, 1:], twin.discrepancy.rest[:, 1:]
    other = replace(twin.discrepancy, ring=ring, rest=rest)
    replace(twin, discrepancy=other).write(tmp_path / "twin")
    with pytest.raises(ModelError, match="ring"):
        Twin.read(tmp_path / "twin")


def test_nothing_teaches_nothing():
    with pytest.raises(InputError, match="no case"):
        known(np.empty((0, 2)), np.empty((0, 3)))


def test_a_net_with_a_discrepancy_differs_from_one_without():
    assert net_in(erring_twin(cases=10), 0.4, 0.1).error.origin == "virtual field"
    assert net_in(level_1_twin(), 0.4, 0.1).error.origin is None


def moved(size: float) -> np.ndarray:
    """A net that the current has taken east, the deeper the farther."""
    depth = CAGE.design_position[:, 2:] / CAGE.design_position[:, 2].min()
    return size * depth * [1.0, 0.0, 0.0]


def test_a_net_at_level_2_errs_as_nets_of_the_family_do():
    twin = stand_in_twin()
    net = net_in(twin, 0.4, 0.1)
    assert net.error.origin == "virtual field"
    wall = net.expected_position[CAGE.node(4, 0)][None]
    assert 0.4 < net.clearance(wall).sigma[0] < 5.0


def test_the_error_of_the_family_is_larger_in_faster_water_and_along_it():
    slow, fast = (ShapeError.of_family(CAGE, moved(one), np.array([0.5, 0.0])) for one in (1, 20))
    small, large = (one.deviation.std(axis=0) for one in (slow, fast))
    assert (small[-1] > 0.3).all()
    # The collar floats: it errs upwards by as little in any current.
    assert (large[1:] > small[1:]).all()
    assert (large[:, 0] > large[:, 1]).all()


@pytest.mark.parametrize("degrees", [30.0, 90.0, 225.0])
def test_the_error_of_the_family_turns_with_the_current(degrees):
    angle = np.deg2rad(degrees)
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    east = ShapeError.of_family(CAGE, moved(9.0), np.array([0.5, 0.0]))
    turned = ShapeError.of_family(CAGE, moved(9.0) @ turn, 0.5 * np.array([cos, sin]))
    np.testing.assert_allclose(turned.deviation, east.deviation @ turn, atol=1e-12)


def test_the_error_of_the_family_is_known_in_slack_water():
    error = ShapeError.of_family(CAGE, moved(0.0), np.zeros(2))
    assert error.weight.sum() == pytest.approx(1.0)
    assert np.isfinite(error.deviation).all()
    np.testing.assert_allclose(error.deviation.mean(axis=0), 0.0, atol=1e-12)
