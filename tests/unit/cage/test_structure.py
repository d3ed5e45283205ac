"""A structure of any topology is read, numbered and refused by its file's own words."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Structure
from seacage.conventions import InputError

TEXT = """
name = "drum"
spokes = 8

[site]
water_depth_m = 30.0
current_to_deg = 0.0

[[section]]
name = "pipe"
kind = "pipe"
diameter_m = 0.3
mass_kg_m = 20.0
axial_stiffness_n = 1e6

[[section]]
name = "rope"
diameter_m = 0.03
mass_kg_m = 0.5
axial_stiffness_n = 1e5

[[twine]]
name = "nylon"
diameter_m = 0.002
half_mesh_m = 0.02
elastic_modulus_pa = 1e9
density_kg_m3 = 1140.0

[[ring]]
name = "collar"
radius_m = 5.0
depth_m = 0.0
section = "pipe"

[[ring]]
name = "foot"
radius_m = 4.0
depth_m = 6.0

[[net]]
name = "side"
twine = "nylon"
upper = "collar"
lower = "foot"
rows = 3

[[net]]
name = "floor"
twine = "nylon"
upper = "foot"
rows = 2

[[tie]]
name = "droppers"
section = "rope"
upper = "collar"
lower = "foot"
every = 2
segments = 2

[[point]]
name = "buoy"
position_m = [15.0, 0.0, 0.0]
displaced_m3 = 0.5

[[anchor]]
name = "north"
position_m = [40.0, 0.0, -30.0]

[[line]]
name = "bridle"
section = "rope"
start = "buoy"
end = "collar/0"

[[line]]
name = "leg"
section = "rope"
start = "buoy"
end = "north"
segments = 4
"""

DRUM = Structure.from_toml(TEXT)


def broken(old: str, new: str) -> None:
    assert old in TEXT
    Structure.from_toml(TEXT.replace(old, new))


def test_a_structure_is_the_same_after_a_round_through_its_file(tmp_path):
    DRUM.write(tmp_path / "drum.toml")
    assert Structure.read(tmp_path / "drum.toml") == DRUM


def test_every_number_in_a_written_file_has_its_unit_and_meaning():
    for line in DRUM.to_toml().splitlines():
        if " = " in line and not line.startswith(("name", "spokes", "tie", "net")):
            assert "# " in line, line


def test_nodes_are_numbered_rings_nets_ties_points_anchors_lines():
    rings, side, floor, droppers, places, leg = 2 * 8, 2 * 8, 8 + 1, 4, 2, 3
    assert DRUM.node_count == rings + side + floor + droppers + places + leg
    np.testing.assert_array_equal(DRUM.ring_nodes("foot"), np.arange(8, 16))
    np.testing.assert_array_equal(DRUM.net_nodes(0)[:, 0], [0, 16, 24, 8])
    np.testing.assert_array_equal(DRUM.net_nodes(1)[:, 1], [9, 33, 40])
    np.testing.assert_array_equal(
        DRUM.tie_nodes(0)[:, [0, -1]], [[0, 8], [2, 10], [4, 12], [6, 14]]
    )
    np.testing.assert_array_equal(DRUM.line_nodes(0), [45, 0])
    np.testing.assert_array_equal(DRUM.line_nodes(1), [45, 47, 48, 49, 46])


def test_inner_nodes_lie_straight_between_what_they_join():
    p = DRUM.design_position
    np.testing.assert_allclose(p[DRUM.net_nodes(0)[1, 0]], [14 / 3, 0.0, -2.0])
    np.testing.assert_allclose(p[DRUM.net_nodes(1)[2, 0]], [0.0, 0.0, -6.0])
    np.testing.assert_allclose(p[DRUM.line_nodes(1)[2]], [27.5, 0.0, -15.0])


def test_the_nets_enclose_the_frustum_that_they_span():
    polygon = 4.0 * np.sin(np.pi / 4.0)  # area of an octagon over its radius squared
    frustum = polygon * 6.0 / 3.0 * (25.0 + 20.0 + 16.0)
    np.testing.assert_allclose(DRUM.volume(DRUM.design_position), frustum)


def test_a_roof_faces_up_so_that_a_closed_net_encloses_the_same_volume():
    roof = replace(DRUM.net[1], name="roof", upper="collar", rows=2)
    closed = replace(DRUM, net=(*DRUM.net, roof))
    np.testing.assert_allclose(
        closed.volume(closed.design_position), DRUM.volume(DRUM.design_position)
    )
    assert closed.is_dry(roof)
    assert not closed.is_dry(DRUM.net[0])


def test_a_net_is_knitted_as_built_unless_its_file_says_otherwise():
    row, chord = DRUM.design_net(0)
    np.testing.assert_allclose(row, np.hypot(1.0, 6.0) / 3.0)
    np.testing.assert_allclose(chord[[0, -1]], 2.0 * np.sin(np.pi / 8.0) * np.array([5.0, 4.0]))
    wide = replace(DRUM, net=(replace(DRUM.net[0], upper_width=80.0, height=9.0),))
    row, chord = wide.design_net(0)
    assert (row, chord[0]) == (3.0, 10.0)


def test_edges_join_every_node():
    assert set(DRUM.edges.ravel().tolist()) == set(range(DRUM.node_count))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('end = "north"', 'end = "nort"', "did you mean 'north'"),
        ('end = "collar/0"', 'end = "collar/8"', "numbered 0 to 7"),
        ('end = "collar/0"', 'end = "buoy"', "starts and ends at 'buoy'"),
        (
            'section = "rope"\nstart = "buoy"',
            'section = "chain"\nstart = "buoy"',
            "known are: pipe",
        ),
        ('twine = "nylon"\nupper = "collar"', 'twine = "hemp"\nupper = "collar"', "twine 'hemp'"),
        ('lower = "foot"\nrows', 'lower = "collar"\nrows', "upper and lower are both 'collar'"),
        ('name = "north"', 'name = "buoy"', "two parts of a kind are named 'buoy'"),
        ("position_m = [40.0, 0.0, -30.0]", "position_m = [40.0, -30.0]", "Give x, y and z"),
        ("position_m = [40.0, 0.0, -30.0]", "position_m = [40.0, 0.0, -31.0]", "below the sea bed"),
        ("half_mesh_m = 0.02", "half_mesh_m = 0.002", "leaves no hole"),
        ('kind = "pipe"', 'kind = "tube"', "must be one of 'pipe', 'rope'"),
        ("radius_m = 5.0", "radius_m = 0.0", "radius_m = 0 must be a finite number above 0"),
        ("rows = 3", "rows = 3\ntwines = 'askew'", "must be one of 'along', 'diagonal'"),
        ("segments = 2", "segments = 2\nkind = 'struts'", "would fold"),
        ("displaced_m3 = 0.5", "displaced_m3 = 0.5\nheight_m = 0.0", "height_m above 0"),
        ("spokes = 8", "spokes = 8\nspoke = 8", "did you mean 'spokes'"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(old: str, new: str, says: str):
    with pytest.raises(InputError, match=says):
        broken(old, new)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError, match=r"gone\.toml: the file cannot be read"):
        Structure.read(tmp_path / "gone.toml")
