"""Bridles and sensors: where they are, how they are numbered, what they bear."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

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


def bearing_of(cage, bridle):
    east, north = cage.design_position[cage.bridle_nodes[bridle], :2]
    return np.rad2deg(np.arctan2(east, north)) % 360.0


def turned_bridles(cage, **bearings):
    """A copy with some bridles elsewhere, each by its number from 1."""
    new = list(cage.bridles.bearings)
    for name, bearing in bearings.items():
        new[int(name.removeprefix("bridle_")) - 1] = bearing
    return cage.altered(bridles={"bearings_deg": new})


@settings(max_examples=25)
@given(
    st.lists(st.floats(0.0, 15.0 - 11.25 * 0.7), min_size=24, max_size=24),
    st.integers(4, 24),
)
def test_bridles_at_any_bearing_are_held_there(offsets, count):
    """Each on a spoke of its own, as long as there are spokes enough."""
    cage = replace(ACE, shackle=()).altered(
        mesh={"spokes": 48},
        bridles={
            "bearings_deg": [
                360.0 / count * n + offset for n, offset in enumerate(offsets[:count])
            ],
            "length_offset_m": [0.0] * count,
        },
    )
    if cage.warnings:  # two in one sector, or the room between them is too narrow
        assert np.ptp(cage.sectors) < 1e-12
        return
    assert cage.sectors.min() > 0.4 * 2.0 * np.pi / 48
    np.testing.assert_allclose(cage.sectors.sum(), 2.0 * np.pi)
    np.testing.assert_allclose(cage.spoke_share.sum(), 1.0)
    for bridle, bearing in enumerate(cage.bridles.bearings):
        off = (bearing_of(cage, bridle) - bearing + 180.0) % 360.0 - 180.0
        assert abs(off) < 0.011


def test_spokes_move_to_bridles_and_those_between_in_proportion():
    cage = turned_bridles(ACE, bridle_1=60.0)
    assert cage.warnings == ()
    assert bearing_of(cage, 0) == pytest.approx(60.0)
    np.testing.assert_array_equal(cage.bridle_nodes, ACE.bridle_nodes + (np.arange(12) == 0))
    moved = np.rad2deg(cage.spoke_angles - ACE.spoke_angles)
    np.testing.assert_allclose(moved[4:31], 0.0, atol=1e-9)  # from the bridle at 45° on
    np.testing.assert_allclose(moved[[31, 0, 1, 2, 3]], -0.75 * np.arange(1, 6))
    finer = cage.refined()
    np.testing.assert_allclose(finer.spoke_angles[::2], cage.spoke_angles)
    assert type(cage).from_toml(finer.to_toml()) == finer


def test_a_bridle_that_a_spoke_moves_is_warned_of_from_where_to_where():
    assert ACE.warnings == ()
    assert ACE.rotated(17.0).warnings == ()
    moved = turned_bridles(ACE, bridle_1=50.0, bridle_2=44.0)  # both nearest to one spoke
    (warning,) = moved.warnings
    assert "which moves bridle-1 from 50° to 45°, bridle-2 from 44° to 45°." in warning
    np.testing.assert_array_equal(moved.spoke_angles, ACE.spoke_angles)


@pytest.mark.parametrize(
    ("bearings", "refused"),
    [
        ([], "32 bearings"),
        ([11.25 * n for n in range(31)], "32 bearings"),
        ([11.25 * n for n in range(32)], "round the cage once"),  # clockwise
        ([-22.5 * n % 360.0 for n in range(32)], "round the cage once"),
        ([0.0, 0.0, *(-11.25 * n for n in range(2, 32))], "0.1° to 180° from the next"),
    ],
)
def test_spokes_that_do_not_go_round_once_are_refused(bearings, refused):
    with pytest.raises(InputError, match=refused):
        ACE.altered(mesh={"spoke_bearings_deg": bearings})


def framed(east, north):
    """The reference cage in a frame of other corners."""
    frame = replace(ACE.frame, side=None, corners_east=tuple(east), corners_north=tuple(north))
    return replace(ACE, frame=frame)


def test_a_frame_may_have_any_convex_shape():
    oblong = framed([55.0, -55.0, -55.0, 55.0], [42.0, 42.0, -42.0, -42.0])
    np.testing.assert_allclose(oblong.corner_position[0], [55.0, 42.0, -8.0])
    assert oblong.frame.reach == 42.0
    assert type(oblong).from_toml(oblong.to_toml()) == oblong
    square = framed([42.5, -42.5, -42.5, 42.5], [42.5, 42.5, -42.5, -42.5])
    np.testing.assert_allclose(square.corner_position, ACE.corner_position, atol=1e-12)
    np.testing.assert_allclose(
        square.rotated(30.0).corner_position, ACE.rotated(30.0).corner_position, atol=1e-12
    )


def test_a_bridle_comes_from_the_nearest_corner_that_it_leaves_outwards():
    cage = framed([300.0, -30.0, -30.0], [0.0, 60.0, -60.0])
    ends, corners = cage.design_position[cage.bridle_nodes], cage.corner_position
    line = corners[cage.bridle_corner] - ends
    assert np.all(np.sum((line * ends)[:, :2], axis=1) > 0.0)
    nearest = np.argmin(np.linalg.norm(corners - ends[:, None], axis=-1), axis=1)
    assert np.any(nearest != cage.bridle_corner)


@pytest.mark.parametrize(
    ("east", "north", "refused"),
    [
        ([60.0, -60.0], [0.0, 0.0], "2 corners_east_m with 2 corners_north_m"),
        ([60.0, -60.0, 0.0], [60.0, 60.0], "3 corners_east_m with 2 corners_north_m"),
        ([42.0, 42.0, -42.0, -42.0], [42.0, -42.0, -42.0, 42.0], "counter-clockwise"),
        ([60.0, 0.0, -60.0, 0.0], [0.0, 10.0, 0.0, -60.0], "no room for a collar"),
        ([100.0, -80.9, 30.9, 30.9, -80.9], [0.0, 58.8, -95.1, 95.1, -58.8], "a convex polygon"),
        ([np.inf, -60.0, -60.0], [0.0, 90.0, -90.0], "corners_east_m = inf must be a finite"),
        ([160.0, 60.0, 60.0], [0.0, 90.0, -90.0], "no room for a collar"),
    ],
)
def test_a_frame_that_is_none_is_refused(east, north, refused):
    with pytest.raises(InputError, match=refused):
        framed(east, north)


def test_a_frame_has_a_side_or_corners():
    with pytest.raises(InputError, match="side_m of a square, or corners_east_m with"):
        replace(ACE.frame, side=None)
    with pytest.raises(InputError, match="not both"):
        replace(ACE.frame, corners_east=(1.0,), corners_north=(1.0,))
