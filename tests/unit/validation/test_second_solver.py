"""The second solver's cage is described as its own input describes it."""

import numpy as np

from seacage.cage import Structure
from seacage.conventions import GRAVITY
from seacage.dynamics._parts._structure import assemble_structure
from validation.second_solver import FILE, LINES

CAGE = Structure.read(FILE)
PARTS = assemble_structure(CAGE)


def test_its_lines_have_the_names_of_the_reference():
    assert set(LINES) <= set(CAGE.bridle_names)
    assert len(CAGE.anchor) == 3


def test_the_net_has_520_twines_between_two_spokes_and_1000_from_edge_to_edge():
    row, chord = CAGE.design_net(0)
    half_mesh = CAGE.twine[0].half_mesh
    np.testing.assert_allclose(chord / half_mesh, 520.0)
    np.testing.assert_allclose(CAGE.net[0].rows * row / half_mesh, 1000.0)


def test_a_twine_is_as_stiff_as_there():
    twine = CAGE.twine[0]
    # five digits are given in the file
    np.testing.assert_allclose(twine.stiffness * twine.half_mesh, 4105.0, rtol=1e-4)


def test_pipes_are_as_long_as_there():
    for ring, chord in (("inner collar", 2.618), ("outer collar", 2.775), ("sinker", 2.775)):
        first, second = CAGE.design_position[CAGE.ring_nodes(ring)[:2]]
        np.testing.assert_allclose(np.linalg.norm(second - first), chord, rtol=1e-4)


def test_what_hangs_on_the_net_weighs_as_there():
    section = next(s for s in CAGE.section if s.name == "sinker pipe")
    ours = (section.mass - section.displaced_mass) * 12 * 2.775 * GRAVITY
    there = np.pi / 4.0 * 0.09**2 * (2272.0 - 1025.0) * 12 * 2.775 * GRAVITY
    np.testing.assert_allclose(ours, there, rtol=1e-3)


def test_the_roof_is_dry_and_the_rest_of_the_net_wet():
    assert [CAGE.is_dry(net) for net in CAGE.net] == [False, True, False]
    assert len(PARTS.panels.area) == 12 * (5 + 2)
