import numpy as np
import pytest

from predicted_nets import erring_twin, net_in
from seacage.conventions import InputError
from seacage.testing import stand_in_twin
from seacage.twin import inspection_path


@pytest.mark.parametrize("side", ["inside", "outside"])
@pytest.mark.parametrize("pattern", ["rows", "spiral"])
def test_every_waypoint_keeps_its_stand_off_on_its_side_and_faces_the_net(side, pattern):
    net = net_in(erring_twin(cases=60), 0.5, 0.2)
    way = inspection_path(net, stand_off=2.0, side=side, pattern=pattern)
    near = net.cage.nearest(way.position, net.expected_position)
    assert near.distance.min() > 1.8
    # Where the net is folded a waypoint may be pushed a little farther off one of its walls.
    assert np.quantile(near.distance, 0.95) < 2.05
    assert (near.inside == (side == "inside")).all()
    to_net = near.position - way.position
    np.testing.assert_allclose(way.facing * near.distance[:, None], to_net, atol=1e-6)
    east, north = np.sin(np.deg2rad(way.heading)), np.cos(np.deg2rad(way.heading))
    flat = np.hypot(*way.facing[:, :2].T)
    np.testing.assert_allclose(np.stack([east, north]) * flat, way.facing[:, :2].T, atol=1e-9)
    assert (way.position[:, 2] <= -0.5).all()


@pytest.mark.parametrize("pattern", ["rows", "spiral"])
def test_no_part_of_the_net_is_passed_by(pattern):
    net = net_in(stand_in_twin(), 0.3, 0.0)
    way = inspection_path(
        net, stand_off=2.0, side="outside", pattern=pattern, row_spacing=2.0, step=1.0
    )
    nodes = net.node_position[net.node_position[:, 2] < -1.5]
    seen = np.linalg.norm(nodes[:, None] - way.position, axis=2).min(axis=1)
    # Two metres off, at most a metre beside the nearest row: the sharp tip is seen from farther.
    assert np.quantile(seen, 0.95) < np.hypot(2.0, 1.5)
    assert seen.max() < 4.0


def test_within_a_part_one_can_swim_from_waypoint_to_waypoint():
    net = net_in(erring_twin(cases=60), 0.5, 0.2)
    way = inspection_path(net, side="outside", row_spacing=3.0, step=1.5)
    leg = np.linalg.norm(np.diff(way.position, axis=0), axis=1)[np.diff(way.part) == 0]
    assert leg.max() <= 9.0
    assert (np.diff(way.row) >= 0).all()
    assert np.abs(np.diff(way.position[:, 2])).max() < 9.0


@pytest.mark.slow
def test_rows_come_back_the_way_they_went_and_a_spiral_never_turns():
    net = net_in(stand_in_twin(), 0.0, 0.0)

    def turning(pattern, row):
        way = inspection_path(net, side="outside", pattern=pattern)
        there = way.position[way.row == row]
        angle = np.unwrap(np.arctan2(there[:, 1], there[:, 0]))
        return np.sign(angle[-1] - angle[0])

    assert turning("rows", 0) == -turning("rows", 1) == turning("rows", 2)
    assert turning("spiral", 0) == turning("spiral", 1)


def test_a_stand_off_wider_than_the_cage_is_refused():
    with pytest.raises(InputError, match="smaller stand-off"):
        inspection_path(net_in(stand_in_twin(), 0.0, 0.0), stand_off=40.0)


@pytest.mark.parametrize("sizes", [{"stand_off": 0.0}, {"step": -1.0}, {"row_spacing": np.nan}])
def test_a_size_that_is_none_is_refused(sizes):
    with pytest.raises(InputError, match="above 0 m"):
        inspection_path(net_in(stand_in_twin(), 0.0, 0.0), **sizes)


def test_more_waypoints_than_anyone_swims_are_refused():
    with pytest.raises(InputError, match="waypoints"):
        inspection_path(net_in(stand_in_twin(), 0.0, 0.0), step=0.001)
