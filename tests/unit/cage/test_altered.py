"""A changed copy is checked as a file is, and the first cage stays as it was."""

import pytest

from seacage.cage import Cage
from seacage.conventions import InputError

ACE = Cage.named("ace")


def test_only_the_named_keys_change():
    heavy = ACE.altered(tip={"weight_n": 9800.0}, netting={"half_mesh_m": 0.03})
    assert heavy.tip.weight == 9800.0
    assert heavy.netting.half_mesh == 0.03
    assert heavy.netting.twine_diameter == ACE.netting.twine_diameter
    assert ACE.tip.weight == 980.0


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ({"tipp": {}}, "Cage.altered: no section 'tipp'; there are: site, mesh, collar"),
        ({"shackle": {}}, "no section 'shackle'"),
        ({"name": {}}, "no section 'name'"),
        ({"tip": {"weight": 1.0}}, "Cage.altered, tip: unknown key 'weight'; did you mean"),
        ({"tip": {"weight_n": "1 kN"}}, "Cage.altered, tip, weight_n: must be a number"),
        ({"tip": {"weight_n": -1.0}}, "Tip: weight_n = -1 must be a finite number at least 0"),
        ({"mesh": {"spokes": 16.0}}, "mesh, spokes: must be a whole number, not 16.0"),
        ({"mesh": {"ring_depths_m": 3.0}}, "mesh, ring_depths_m: must be a list, not 3.0"),
    ],
)
def test_a_change_that_a_file_could_not_make_is_refused(sections, message):
    with pytest.raises(InputError) as caught:
        ACE.altered(**sections)
    assert message in str(caught.value)


def test_growth_adds_solidity_above_and_below_its_boundary():
    grown = ACE.fouled(shallow=0.08, deep=0.03)
    clean = ACE.netting.solidity
    assert grown.netting.solidity_at(9.9) == pytest.approx(clean + 0.08)
    assert grown.netting.solidity_at(10.0) == pytest.approx(clean + 0.03)
    assert grown.fouled(shallow=0.0, deep=0.0) == ACE


def test_growth_beyond_a_closed_net_is_refused():
    with pytest.raises(InputError, match=r"the solidity is 0\.911 .*and 0\.7 of growth"):
        ACE.fouled(shallow=0.7, deep=0.0)


def test_a_net_of_285_mm_twine_at_255_mm_is_21_percent_solid():
    # Sn = 2 d/l − (d/l)²; +50 % of twine diameter gives 0.307 (physics.md, section 2)
    assert ACE.netting.solidity == pytest.approx(0.211, abs=5e-4)
    thick = ACE.altered(netting={"twine_diameter_m": 1.5 * 0.00285})
    assert thick.netting.solidity == pytest.approx(0.307, abs=5e-4)


def test_a_metre_of_netting_is_as_stiff_as_its_twines():
    assert ACE.netting.stiffness == pytest.approx(250e3, rel=0.01)  # physics.md, section 4
