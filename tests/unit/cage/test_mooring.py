"""Bridles and sensors: where they are, how they are numbered, what they bear."""

import numpy as np
import pytest

from seacage.cage import Cage, DepthSensor, Shackle
from seacage.conventions import InputError

ACE = Cage.named("ace")


def edited(old: str, new: str) -> Cage:
    text = ACE.to_toml()
    assert text.count(old) == 1
    return Cage.from_toml(text.replace(old, new))


def test_the_frame_is_a_square_of_85_m_at_8_m_depth():
    corners = [(42.5, 42.5), (-42.5, 42.5), (-42.5, -42.5), (42.5, -42.5)]  # NE, NW, SW, SE
    np.testing.assert_allclose(ACE.corner_position[:, :2], corners)
    np.testing.assert_allclose(ACE.corner_position[:, 2], -8.0)


def test_three_bridles_go_from_each_corner_to_the_collar():
    np.testing.assert_array_equal(ACE.bridle_corner, np.repeat([0, 1, 2, 3], 3))
    spokes = [2, 4, 6, 10, 12, 14, 18, 20, 22, 26, 28, 30]
    np.testing.assert_array_equal(ACE.bridle_nodes, spokes)
    assert ACE.bridle_names[0] == "bridle-1"
    assert ACE.bridle_names[-1] == "bridle-12"
    assert ACE.bridle_count == 12


def test_the_middle_bridle_spans_36_m_and_its_neighbours_39():
    ends = ACE.design_position[ACE.bridle_nodes], ACE.corner_position[ACE.bridle_corner]
    span = np.linalg.norm(ends[1] - ends[0], axis=1)
    np.testing.assert_allclose(span, np.tile([39.05, 36.0, 39.05], 4), atol=0.05)


def test_a_bridle_may_bear_its_breaking_load_over_the_material_factor():
    np.testing.assert_allclose(ACE.bridle_capacity, 480e3 / 3.0)


def test_shackles_sit_on_bridles_7_to_11():
    expected = tuple(Shackle(name=f"shackle-{k + 1}", bridle=k + 6) for k in range(5))
    assert ACE.shackles == expected


def test_depth_sensors_sit_on_nodes_at_7_15_and_31_m_on_the_south_side():
    nodes = {"depth-1": 88, "depth-2": 184, "depth-3": 320}
    assert ACE.depth_sensors == tuple(DepthSensor(name=n, node=k) for n, k in nodes.items())
    np.testing.assert_allclose(ACE.design_position[88], [0.0, -25.0, -7.0], atol=1e-12)


def test_depth_sensors_come_first_among_the_names():
    assert ACE.sensor_names[:4] == ("depth-1", "depth-2", "depth-3", "shackle-1")


def test_a_sensor_keeps_its_place_in_a_finer_net():
    for coarse, fine in zip(ACE.depth_sensors, ACE.refined().depth_sensors, strict=True):
        np.testing.assert_allclose(
            ACE.refined().design_position[fine.node],
            ACE.design_position[coarse.node],
            atol=1e-12,
        )


def test_turning_the_cage_turns_net_mooring_and_sensors_clockwise():
    turned = ACE.rotated(90.0)
    clockwise = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(
        turned.design_position, ACE.design_position @ clockwise.T, atol=1e-12
    )
    np.testing.assert_allclose(
        turned.corner_position, ACE.corner_position @ clockwise.T, atol=1e-12
    )
    np.testing.assert_array_equal(turned.bridle_nodes, ACE.bridle_nodes)
    np.testing.assert_array_equal(turned.bridle_corner, ACE.bridle_corner)
    assert turned.depth_sensors == ACE.depth_sensors
    assert turned.rotated(270.0) == ACE


def test_two_sensors_of_one_name_are_refused():
    with pytest.raises(InputError, match=r"Cage ace: two sensors share a name in .*depth-2"):
        edited('name = "depth-1"', 'name = "depth-2"')


def test_a_shackle_on_a_bridle_that_is_not_there_is_refused():
    with pytest.raises(InputError, match=r"shackle-1 sits on bridle 13, but there are 12"):
        edited("bridle = 7 ", "bridle = 13 ")


def test_a_cage_without_bridles_is_refused():
    with pytest.raises(InputError, match="bearings_deg is empty"):
        ACE.altered(bridles={"bearings_deg": [], "length_offset_m": []})


def test_each_bridle_has_one_length_offset():
    with pytest.raises(InputError, match=r"12 bearings_deg but 1 length_offset_m"):
        ACE.altered(bridles={"length_offset_m": [0.1]})


def test_a_bridle_that_a_spoke_moves_is_warned_of_from_where_to_where():
    assert ACE.warnings == ()
    assert ACE.rotated(17.0).warnings == ()
    bearings = list(ACE.bridles.bearings)
    bearings[0] = 60.0
    (warning,) = ACE.altered(bridles={"bearings_deg": bearings}).warnings
    assert "which moves bridle-1 from 60° to 56.25°." in warning
    bearings[3] = 359.0
    (warning,) = ACE.altered(bridles={"bearings_deg": bearings}).warnings
    assert "bridle-1 from 60° to 56.25°, bridle-4 from 359° to 0°." in warning
