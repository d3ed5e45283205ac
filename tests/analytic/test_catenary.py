"""The catenary against other programs' lines and its own closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seacage.conventions import GRAVITY, WATER_DENSITY, InputError
from seacage.dynamics import catenary

# Spans, length [m], EA [N], weight [N/m], friction of the sea bed (None: no sea bed), then the
# forces on A and on B, horizontal and vertical [N]: the line cases of MoorPy's own tests,
# to every digit.
MOORPY = [
    (
        400.0,
        200.0,
        500.0,
        7510000000000.0,
        800.0,
        5.0,
        0.0,
        0.0,
        -96643.43501616362,
        -237751.75997440016,
    ),
    (
        400.0,
        200.0,
        500.0,
        7510000000000.0,
        800.0,
        0.0,
        96643.42815934008,
        0.0,
        -96643.42815934008,
        -237751.75535996316,
    ),
    (
        400.0,
        200.0,
        500.0,
        7510000000000.0,
        800.0,
        0.1,
        80418.60434855078,
        0.0,
        -96643.42877136687,
        -237751.75577183915,
    ),
    (
        400.0,
        200.0,
        500.0,
        7510000000000.0,
        200.0,
        None,
        43694.580989249596,
        -22365.599350216216,
        -43694.580989249596,
        -77634.40064978378,
    ),
    (
        89.9,
        59.2,
        130.0,
        751000000.0,
        881.05,
        None,
        31373.229006023103,
        -26650.341270116318,
        -31373.229006023103,
        -87886.15872988368,
    ),
]
# Diameter [m], mass [kg/m], EA [N], span, depth, length [m], then the tension at the top and at
# the anchor [kN]: the chains of MoorDyn's static tests, in water of 1025 kg/m3.
CHAINS = [
    (0.252, 390.0, 1.674e9, 400.0, 50.0, 410.0, 991.6, 826.2),
    (0.252, 390.0, 1.674e9, 700.0, 200.0, 760.0, 2065.4, 1402.2),
]


def forces(*line, seabed_friction=None):
    return np.ravel(catenary(*map(float, line), seabed_friction=seabed_friction))


@pytest.mark.parametrize("case", MOORPY)
def test_moorpys_lines_are_met(case):
    found = forces(*case[:5], seabed_friction=case[5])
    np.testing.assert_allclose(found, case[6:], rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("case", CHAINS)
def test_moordyns_chains_are_met(case):
    diameter, mass, stiffness, span, depth, length, top, anchor = case
    weight = (mass - WATER_DENSITY * math.pi / 4.0 * diameter**2) * GRAVITY
    found = forces(span, depth, length, stiffness, weight, seabed_friction=0.0) / 1e3
    # that suite's own tolerance, for lines of few segments; found: +1.0 and +1.1 % of the first
    # chain, +0.2 and +0.3 % of the second
    assert math.hypot(*found[2:]) == pytest.approx(top, rel=0.10)
    assert math.hypot(*found[:2]) == pytest.approx(anchor, rel=0.10)


@pytest.mark.parametrize("friction", [None, 0.0, 0.4, 3.0])
@pytest.mark.parametrize("length", [101.0, 130.0])
def test_the_two_ends_and_the_bed_bear_the_line(length, friction):
    weight = 250.0
    ah, av, bh, bv = forces(60.0, 80.0, length, 1e7, weight, seabed_friction=friction)
    lying = 0.0 if friction is None else max(length + bv / weight, 0.0)
    assert av + bv == pytest.approx(-weight * (length - lying))
    assert 0.0 <= ah <= -bh * (1.0 + 1e-12)
    assert -bh - ah == pytest.approx(min((friction or 0.0) * weight * lying, -bh))


def test_a_line_without_a_sea_bed_that_hangs_clear_feels_none():
    clear = (60.0, 80.0, 101.0, 1e7, 250.0)
    np.testing.assert_allclose(forces(*clear), forces(*clear, seabed_friction=0.7), rtol=1e-9)


def test_between_level_ends_it_is_symmetric():
    ah, av, bh, bv = forces(100.0, 0.0, 110.0, 1e9, 50.0)
    assert (ah, av) == pytest.approx((-bh, bv))
    assert bv == pytest.approx(-50.0 * 110.0 / 2.0)


def test_an_inextensible_level_line_meets_the_classical_sag():
    # s = 2 (H/w) sinh(w x / 2 H): H from the closed form's own length
    horizontal, weight, span = 4000.0, 50.0, 100.0
    length = 2.0 * horizontal / weight * math.sinh(weight * span / (2.0 * horizontal))
    ah, _, _, _ = forces(span, 0.0, length, 1e14, weight)
    assert ah == pytest.approx(horizontal, rel=1e-6)


def test_a_taut_light_line_is_a_spring():
    # 3-4-5, stretched by 1 %: weight adds only 10 N to 10 kN
    ah, av, bh, bv = forces(30.0, 40.0, 50.0 / 1.01, 1e6, 0.2)
    tension = 1e6 * 0.01
    np.testing.assert_allclose((ah, av), (0.6 * tension, 0.8 * tension), rtol=2e-3)
    np.testing.assert_allclose((bh, bv), (-ah, -av), rtol=2e-3)


def test_a_very_slack_line_hangs_nearly_plumb():
    # 100 m down-and-up between ends 1 m apart: each end bears half of it, with hardly any pull
    ah, av, _, bv = forces(1.0, 0.0, 100.0, 1e9, 50.0)
    assert av == pytest.approx(-2500.0)
    assert bv == pytest.approx(-2500.0)
    assert 0.0 < ah < 10.0


def test_a_softer_line_pulls_less():
    pulls = [forces(400.0, 200.0, 450.0, ea, 200.0)[0] for ea in (1e6, 1e7, 1e8, 1e12)]
    assert np.all(np.diff(pulls) > 0.0)


@settings(max_examples=40)
@given(
    slope=st.floats(0.0, 10.0),
    excess=st.floats(-0.3, 2.0),
    log_stiffness=st.floats(4.0, 12.0),
    log_weight=st.floats(-1.0, 4.0),
    friction=st.sampled_from([None, 0.0, 0.5, 5.0]),
)
def test_any_line_has_its_catenary_unless_it_lies_loose(
    slope, excess, log_stiffness, log_weight, friction
):
    x, z = 100.0, 100.0 * slope
    length = math.hypot(x, z) * (1.0 + excess)
    stiffness, weight = 10.0**log_stiffness, 10.0**log_weight
    # what hangs plumb from B, unstretched, when the rest lies on the bed
    plumb = 2.0 * z / (1.0 + math.sqrt(1.0 + 2.0 * weight * z / stiffness))
    if friction is not None and length - plumb >= x * (1.0 - 1e-9):
        with pytest.raises(InputError, match="hangs plumb"):
            forces(x, z, length * (1.0 + 1e-8), stiffness, weight, seabed_friction=friction)
        return
    ah, av, bh, bv = forces(x, z, length, stiffness, weight, seabed_friction=friction)
    assert 0.0 <= ah <= -bh * (1.0 + 1e-12)
    carried = weight * length if av != 0.0 else min(weight * length, -bv)
    tension = math.hypot(bh, bv)
    assert av + bv == pytest.approx(-carried, rel=1e-9, abs=1e-12 * tension)
    # not even with the top's tension all along could it reach further
    assert math.hypot(x, z) <= length * (1.0 + tension / stiffness) * (1.0 + 1e-9)


@pytest.mark.parametrize(
    ("line", "friction", "message"),
    [
        ((0.0, 5.0, 9.0, 1e6, 3.0), None, "x_span (m) = 0 must be above 0"),
        ((4.0, 5.0, -9.0, 1e6, 3.0), None, "length (m) = -9 must be above 0"),
        ((4.0, 5.0, 9.0, math.nan, 3.0), None, "axial_stiffness (N) = nan must be above 0"),
        ((4.0, 5.0, 9.0, 1e6, 0.0), None, "weight (N/m) = 0 must be above 0"),
        ((4.0, -5.0, 9.0, 1e6, 3.0), None, "z_span = -5 m must be at least 0. Take the lower"),
        ((4.0, math.inf, 9.0, 1e6, 3.0), None, "z_span = inf m"),
        ((4.0, 5.0, 7.0, 1e6, 3.0), -0.1, "seabed_friction = -0.1 must be at least 0"),
        ((4.0, 5.0, 9.1, 1e6, 3.0), 0.5, "9.1 m of line across 4 m and up 5 m hangs plumb"),
    ],
)
def test_a_line_that_cannot_be_is_refused(line, friction, message):
    with pytest.raises(InputError) as caught:
        catenary(*line, seabed_friction=friction)
    assert message in str(caught.value)
