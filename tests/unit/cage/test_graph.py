"""The net's graph: where its nodes are, and which of them edges and panels join."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from seacage.cage import Cage

ACE = Cage.named("ace")


def meshed(rings: int, spokes: int) -> Cage:
    depths = np.linspace(0.0, 25.0, rings).tolist()
    return ACE.altered(
        mesh={"spokes": spokes, "ring_depths_m": depths, "cylinder_depth_m": depths[1]}
    )


# What makes a cage is drawn, not the cage: checking its annotations uses `random`.
any_mesh = given(rings=st.integers(2, 12), spokes=st.integers(3, 40))


def corner_sets(panels):
    """Each panel's corners, a triangle's repeated one once."""
    return [set(corners) for corners in panels.tolist()]


def test_the_reference_cage_has_the_published_count_of_everything():
    assert (ACE.rings, ACE.spokes, ACE.node_count, ACE.bottom_node) == (10, 32, 321, 320)
    assert ACE.design_position.shape == (321, 3)
    assert ACE.edges.shape == (640, 2)
    corners = [len(nodes) for nodes in corner_sets(ACE.panels)]
    assert (corners.count(4), corners.count(3)) == (288, 32)


def test_spoke_0_is_east_and_the_others_follow_counter_clockwise():
    east, next_to_it, north, west, south = ACE.design_position[[0, 1, 8, 16, 24]]
    np.testing.assert_allclose(east, [25.0, 0.0, 0.0], atol=1e-12)
    assert next_to_it[1] > 0.0
    np.testing.assert_allclose(north, [0.0, 25.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(west, [-25.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(south, [0.0, -25.0, 0.0], atol=1e-12)


def test_a_node_is_32_times_its_ring_plus_its_spoke():
    assert ACE.node(2, 24) == 88
    assert ACE.node(5, 24) == 184
    assert ACE.node(3, 33) == ACE.node(3, 1) == 97  # spokes count round and round
    np.testing.assert_array_equal(ACE.ring_nodes(1), np.arange(32, 64))


def test_rings_lie_at_their_depths_on_a_cylinder_and_a_cone():
    position = ACE.design_position
    for ring, depth in enumerate(ACE.mesh.ring_depths):
        nodes = position[ACE.ring_nodes(ring)]
        radius = 25.0 * min(1.0, (31.0 - depth) / 16.0)
        np.testing.assert_allclose(nodes[:, 2], -depth)
        np.testing.assert_allclose(np.hypot(nodes[:, 0], nodes[:, 1]), radius)
    np.testing.assert_array_equal(position[ACE.bottom_node], [0.0, 0.0, -31.0])
    assert ACE.tube_ring == 5


@any_mesh
def test_edges_are_rings_and_meridians_each_named_once(rings, spokes):
    cage = meshed(rings, spokes)
    assert cage.edges.shape == (2 * rings * spokes, 2)
    named = {frozenset(pair) for pair in cage.edges.tolist()}
    assert len(named) == len(cage.edges)
    assert frozenset({cage.node(0, spokes - 1), cage.node(0, 0)}) in named
    assert frozenset({cage.node(rings - 1, 1), cage.bottom_node}) in named
    joined = np.bincount(cage.edges.ravel(), minlength=cage.node_count)
    assert np.all(joined[cage.ring_nodes(0)] == 3)  # the collar has nothing above
    assert np.all(joined[spokes : rings * spokes] == 4)
    assert joined[cage.bottom_node] == spokes


@any_mesh
def test_panels_close_the_net_each_edge_between_two_of_them_but_for_the_collar(rings, spokes):
    cage = meshed(rings, spokes)
    assert cage.panels.shape == (rings * spokes, 4)
    sides = Counter(
        frozenset({a, b})
        for corners in cage.panels.tolist()
        for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)
        if a != b
    )
    collar = {frozenset({n, cage.node(0, n + 1)}) for n in range(cage.spokes)}
    for edge in map(frozenset, cage.edges.tolist()):
        assert sides[edge] == (1 if edge in collar else 2)


@any_mesh
def test_every_panel_faces_outwards(rings, spokes):
    cage = meshed(rings, spokes)
    a, b, c, d = np.moveaxis(cage.design_position[cage.panels], 1, 0)
    normal = np.cross(c - a, d - b)
    inside = np.array([0.0, 0.0, -cage.mesh.cylinder_depth / 2.0])
    assert np.all(np.sum(normal * ((a + b + c + d) / 4.0 - inside), axis=1) > 0.0)


def test_the_design_volume_is_that_of_a_32_sided_cylinder_and_cone():
    polygon = 32 / 2.0 * 25.0**2 * np.sin(2.0 * np.pi / 32)
    # a cylinder of 15 m and a cone of 16 m; the panels of the cone are flat, so nothing is lost
    assert ACE.volume(ACE.design_position) == pytest.approx(polygon * (15.0 + 16.0 / 3.0))
    assert ACE.volume(ACE.design_position) == pytest.approx(39_667.0, rel=1e-4)  # physics.md


def test_the_volume_does_not_move_with_the_cage_and_takes_any_number_of_shapes():
    shapes = ACE.design_position + np.array([[[0.0, 0.0, 0.0]], [[400.0, -70.0, 3.0]]])
    np.testing.assert_allclose(ACE.volume(shapes), 39_668.4, atol=0.1)
    assert ACE.volume(shapes[None]).shape == (1, 2)


def test_a_squeezed_net_holds_what_its_stretch_says():
    squeezed = ACE.design_position * np.array([0.5, 1.0, 0.8])
    expected = 0.4 * ACE.volume(ACE.design_position)
    assert ACE.volume(squeezed) == pytest.approx(expected)


@given(rings=st.integers(2, 6), spokes=st.integers(3, 12))
def test_refining_keeps_every_old_node_in_its_place(rings, spokes):
    cage = meshed(rings, spokes)
    finer = cage.refined()
    assert (finer.rings, finer.spokes) == (2 * cage.rings, 2 * cage.spokes)
    for ring in range(cage.rings):
        old = cage.design_position[cage.ring_nodes(ring)]
        new = finer.design_position[finer.ring_nodes(2 * ring)[::2]]
        np.testing.assert_allclose(new, old, atol=1e-12)
    bottom = finer.design_position[finer.bottom_node]
    np.testing.assert_array_equal(bottom, cage.design_position[cage.bottom_node])


def test_nobody_can_write_into_what_a_cage_hands_out():
    with pytest.raises(ValueError, match="read-only"):
        ACE.design_position[0] = 0.0
