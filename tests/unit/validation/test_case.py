"""A user's case: one TOML, one CSV, and a clear sentence where one of them is wrong."""

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import loland, rest_shape, settle
from seacage.ocean import SeaState
from validation import Kind
from validation._answers import How, Water, answers
from validation._case import CASES, read_case, read_cases
from validation._quantities import Conditions, quantity_named
from validation.own_cases import rows_of_case

README = Path(__file__).parents[3] / "validation" / "README.md"

HOW = How(
    mooring="springs",
    hold_collar=True,
    pipe_drag=True,
    present_area=False,
    wake=True,
    twine_drag=None,
    spin_up=300.0,
    duration=60.0,
    time_step=0.002,
)

TOML = """
title = "A tank"
kind = "measured"
source = "a report"
cage = "ace"
collar = "held"
laws = ["loland"]

[changes.tip]
weight_n = 2000.0

[tolerance.net_drag_kn]
share = 0.1
reason = "the tank's own"

[tolerance."rise_m:tip"]
fixed = 0.5
reason = "the ruler's"
"""
CSV = """current_speed_m_s,net_drag_kn,uncertainty:net_drag_kn,rise_m:tip
0.2,12,1,
0.3,25,,3.5
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "case.toml").write_text(TOML)
    (tmp_path / "measured.csv").write_text(CSV)
    return tmp_path


def test_a_case_says_which_cage_was_measured_and_what(folder):
    case = read_case(folder)
    assert (case.title, case.kind, case.how.hold_collar) == ("A tank", Kind.MEASURED, True)
    assert [cage.tip.weight for cage in case.subjects] == [2000.0]
    read = [
        (m.at.water.sea.current_speed, m.quantity.name, m.value, m.uncertainty)
        for m in case.measured
    ]
    assert read == [
        (0.2, "net_drag_kn", 12.0, 1.0),
        (0.3, "net_drag_kn", 25.0, 0.0),
        (0.3, "rise_m:tip", 3.5, 0.0),
    ]


def test_each_measured_number_becomes_a_row(folder):
    first, second, third = rows_of_case(read_case(folder))
    assert (first.reference, first.unit, second.reference) == ((11.0, 13.0), "kN", 25.0)
    assert (second.tolerance, third.tolerance) == (2.5, 0.5)
    cage = Cage.named("ace").altered(tip={"weight_n": 2000.0})
    sea = SeaState(current_speed=0.3, current_to=0.0)
    response = settle(cage, sea, law="loland", hold_collar=True)
    assert second.ours == pytest.approx(response.net_force[1] / 1e3)
    assert third.ours == pytest.approx(response.node_displacement[cage.bottom_node, 2])


@pytest.mark.slow
def test_an_ensemble_spans_every_combination_and_law(folder):
    ensemble = '[ensemble]\n"tip.weight_n" = [500.0, 5000.0]\n'
    (folder / "case.toml").write_text(
        TOML.replace('["loland"]', '["loland", "aarsnes"]') + ensemble
    )
    (folder / "measured.csv").write_text("current_speed_m_s,net_drag_kn\n0.3,25\n")
    case = read_case(folder)
    assert [cage.tip.weight for cage in case.subjects] == [500.0, 5000.0]
    (row,) = rows_of_case(case)
    low, high = row.ours
    assert low < high


def test_a_line_may_name_its_law_its_direction_and_a_note(folder):
    (folder / "measured.csv").write_text(
        "law,current_speed_m_s,current_to_deg,net_drag_kn,note\naarsnes,0.3,90,25,odd\n"
    )
    (row,) = rows_of_case(read_case(folder))
    assert row.what == "A tank: drag of the net, 0.3 m/s, to 90°, aarsnes"
    assert row.note == "odd"


def test_a_tolerance_follows_the_last_digit_that_is_printed(folder):
    (folder / "case.toml").write_text(TOML.replace("share = 0.1", "share = 0.1\nlast_digits = 0.5"))
    (folder / "measured.csv").write_text("current_speed_m_s,net_drag_kn\n0.2,12\n0.3,25.0\n")
    first, second = rows_of_case(read_case(folder))
    assert (first.tolerance, second.tolerance) == pytest.approx((1.2 + 0.5, 2.5 + 0.05))


def test_a_line_alone_may_miss(folder):
    (folder / "case.toml").write_text(TOML.replace("[changes", "must_hold = true\n[changes"))
    (folder / "measured.csv").write_text(
        "current_speed_m_s,net_drag_kn,may_miss\n0.2,12,\n0.3,99,yes\n"
    )
    first, second = rows_of_case(read_case(folder))
    assert (first.must_hold, second.must_hold, second.fails) == (True, False, False)


def examples():
    """The two files of each example in the README."""
    blocks = re.findall(r"```(?:toml)?\n(.*?)```", README.read_text("utf-8"), re.DOTALL)
    return [(a, b) for a, b in pairwise(blocks) if b.startswith("current_speed")]


@pytest.mark.parametrize("number", [0, 1])
def test_the_examples_of_the_readme_work_as_they_stand(tmp_path, number):
    toml, table = examples()[number]
    (tmp_path / "case.toml").write_text(toml, "utf-8")
    (tmp_path / "measured.csv").write_text(table, "utf-8")
    case = read_case(tmp_path)
    # a moment stands for the half-hour
    brief = replace(case, how=replace(case.how, spin_up=2.0, duration=1.0))
    rows = list(rows_of_case(brief))
    assert len(rows) == len(case.measured)
    assert all(np.all(np.isfinite(row.ours)) for row in rows)


def test_a_moored_cage_in_waves_is_simulated_as_long_as_its_statistics_need(tmp_path):
    toml, table = examples()[0]
    (tmp_path / "case.toml").write_text(toml, "utf-8")
    (tmp_path / "measured.csv").write_text(table, "utf-8")
    case = read_case(tmp_path)
    assert (case.how.mooring, case.how.duration) == ("catenary", 1800.0)
    calm, irregular, regular = dict.fromkeys(number.at.water for number in case.measured)
    assert (calm.has_waves, irregular.sea.tp, regular.height) == (False, 6.7, 2.0)


def test_regular_and_irregular_waves_do_not_mix(folder):
    (folder / "measured.csv").write_text(
        "current_speed_m_s,hs_m,wave_height_m,wave_period_s,net_drag_kn\n0.2,1.0,1.0,6.0,12\n"
    )
    with pytest.raises(InputError, match="line 2: regular waves have wave_height_m and wave_per"):
        read_case(folder)


def test_the_cases_that_come_with_seacage_are_read():
    names = [case.name for case in read_cases()]
    assert names == sorted(path.parent.name for path in CASES.glob("*/case.toml"))
    assert "held_collar_model" in names


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("title =", "head =", "key 'title' is missing"),
        ('cage = "ace"', 'cage = "ace"\ncolour = 3', "key 'colour' is unknown"),
        ('"measured"', '"measure"', "kind 'measure' is unknown; did you mean 'measured'?"),
        ('"held"', '"hold"', "collar 'hold' is unknown; did you mean 'held'?"),
        ("[changes", 'mooring = "spring"\n[changes', "mooring 'spring' is unknown; did you mean"),
        ('["loland"]', '["lolland"]', "laws 'lolland' is unknown; did you mean 'loland'?"),
        ('["loland"]', "3", "laws must be a list, not 3"),
        ('"ace"', '"mine.toml"', "there is no cage file mine.toml beside it"),
        ('cage = "ace"', "", "must have one of cage, structure and [panel], not 0"),
        ('cage = "ace"', 'structure = "a.toml"', "there is no structure file a.toml beside it"),
        ('cage = "ace"', "[panel]", "[panel] key 'collar' is unknown"),
        ('cage = "ace"', 'cage = "ace"\ntwine_drag = [1.2]', "twine_drag = [1.2] must be two"),
        ("weight_n = 2000.0", "weight = 2.0", "unknown key 'weight'; did you mean 'weight_n'?"),
        ("share = 0.1", "share = -0.1", "share = -0.1 must be a number of at least 0"),
        ("share = 0.1", "shares = 0.1", "key 'shares' is unknown; did you mean 'share'?"),
        ('reason = "the ruler\'s"', "", "the key reason is missing"),
        (
            "[tolerance.net_drag_kn]",
            "[tolerance.volume_m3]",
            '[tolerance."net_drag_kn"] is missing',
        ),
        ("title = ", "title ", "this is not TOML"),
        ('cage = "ace"', 'cage = "ace"\nensemble = {tip = 3}', "ensemble key 'tip' must name"),
    ],
)
def test_a_wrong_toml_is_refused_in_one_sentence(folder, old, new, message):
    assert old in TOML
    (folder / "case.toml").write_text(TOML.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        read_case(folder)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("speed,net_drag_kn\n0.2,3\n", "the column current_speed_m_s is missing"),
        ("current_speed_m_s,drag\n0.2,3\n", "column 'drag' is no quantity. Known are: net_drag_kn"),
        ("current_speed_m_s,net_drag_kn\n0.2,3\n0.3,x\n", "line 3: net_drag_kn = 'x' is no number"),
        ("current_speed_m_s,rise_m:top\n0.2,3\n", "'top' is no place of the cage. Write tip"),
        ("current_speed_m_s,depth_m:10:3\n0.2,3\n", "rings 0 to 9 and spokes 0 to 31"),
        ("current_speed_m_s,line_tension_kn:13\n0.2,3\n", "lines are: bridle-1, bridle-2,"),
        ("current_speed_m_s,uncertainty:net_drag_kn\n0.2,3\n", "'uncertainty:net_drag_kn' is unk"),
        (
            "current_speed_m_s,net_drag_kn\n9,3\n",
            "line 2: SeaState: current_speed = 9 m/s is above",
        ),
        ("current_speed_m_s,net_drag_kn\n0.2,\n", "it holds no measured number"),
    ],
)
def test_a_wrong_csv_is_refused_in_one_sentence(folder, text, message):
    (folder / "measured.csv").write_text(text)
    with pytest.raises(InputError) as caught:
        read_case(folder)
    assert message in str(caught.value)


def test_a_case_without_numbers_is_refused(folder):
    (folder / "measured.csv").unlink()
    with pytest.raises(InputError, match=r"measured\.csv is missing beside"):
        read_case(folder)


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("net_drag_n", lambda r, _: r.net_force[1]),
        ("net_lift_kn", lambda r, _: r.net_force[2] / 1e3),
        ("volume_m3", lambda r, _: r.volume),
        ("volume_loss_percent", lambda r, _: 100.0 * (1.0 - r.volume_fraction)),
        (
            "design_volume_loss_percent",
            lambda r, cage: 100.0 * (1.0 - r.volume / cage.volume(cage.design_position)),
        ),
        ("depth_m:depth-2", lambda r, cage: -r.node_position[cage.depth_sensors[1].node, 2]),
        ("depth_m:5:24", lambda r, cage: -r.node_position[cage.node(5, 24), 2]),
        ("rise_m:tip", lambda r, cage: r.node_displacement[cage.bottom_node, 2]),
        ("design_rise_m:tip", lambda r, cage: r.node_position[cage.bottom_node, 2] + 31.0),
        ("line_tension_kn:7", lambda r, _: r.bridle_tension[6] / 1e3),
        ("line_tension_max_kn:bridle-7", lambda r, _: r.bridle_tension[6] / 1e3),
        ("line_tension_std_kn:bridle-7", lambda _r, _c: 0.0),
    ],
)
def test_each_quantity_is_read_as_its_name_says(column, value):
    cage, sea = Cage.named("ace"), SeaState(current_speed=0.2, current_to=0.0)
    water = Water(sea=sea)
    (answer,) = answers(cage, [water], "loland", HOW)
    found = quantity_named(column, cage, "here").read(answer, Conditions(water=water))
    response = settle(cage, sea, law="loland", mooring="springs", hold_collar=True)
    assert found == pytest.approx(float(value(response, cage)))


PANEL = """
title = "A flume"
kind = "measured"
source = "a report"

[panel]
twine_diameter_m = 0.0028
half_mesh_m = 0.029
area_m2 = 2.0

[tolerance]
"""


def test_a_panel_of_netting_is_a_case_too(tmp_path):
    tolerances = "\n".join(
        f'{name} = {{reason = "R"}}' for name in ("cd", "cl", "drag_n", "lift_n")
    )
    (tmp_path / "case.toml").write_text(PANEL + tolerances)
    (tmp_path / "measured.csv").write_text(
        "law,current_speed_m_s,angle_deg,solidity,cd,cl,drag_n,lift_n\n"
        "loland,0.5,45,0.2,0.2,0.1,40,20\n"
        ",0.5,90,,0.2,,,\n"
    )
    cd, cl, drag, lift, facing = rows_of_case(read_case(tmp_path))
    assert (cd.ours, cl.ours) == pytest.approx(loland(0.2, np.sqrt(0.5)))
    assert drag.ours == pytest.approx(cd.ours * 0.5 * 1000.0 * 0.25 * 2.0)
    assert lift.ours == pytest.approx(cl.ours * 0.5 * 1000.0 * 0.25 * 2.0)
    assert cd.what == "A flume: drag coefficient, 0.5 m/s, 45° to the flow, solidity 0.2, loland"
    low, high = facing.ours  # of all four laws
    assert low < high


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("half_mesh_m", "mesh_m", "[panel] key 'mesh_m' is unknown"),
        ("half_mesh_m = 0.029", "", "[panel] key 'half_mesh_m' is missing"),
        ("area_m2 = 2.0", "area_m2 = 0.0", "[panel] area_m2 = 0.0 must be a number above 0"),
    ],
)
def test_a_wrong_panel_is_refused_in_one_sentence(tmp_path, old, new, message):
    (tmp_path / "case.toml").write_text(PANEL.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_case(tmp_path)
    assert message in str(caught.value)


TANK = """
name = "tank"
spokes = 8
[site]
water_depth_m = 5.0
current_to_deg = 0.0
[[section]]
name = "hoop"
kind = "pipe"
diameter_m = 0.08
mass_kg_m = 1.0
axial_stiffness_n = 2e4
bending_stiffness_n_m2 = 50.0
[[section]]
name = "weights"
kind = "rope"
diameter_m = 0.03
mass_kg_m = 2.0
axial_stiffness_n = 2e4
[[twine]]
name = "twine"
diameter_m = 0.0018
half_mesh_m = 0.016
elastic_modulus_pa = 1e8
density_kg_m3 = 1140.0
[[ring]]
name = "top"
radius_m = 0.75
depth_m = 0.0
section = "hoop"
[[ring]]
name = "bottom"
radius_m = 0.75
depth_m = 1.4
section = "weights"
[[net]]
name = "side"
twine = "twine"
upper = "top"
lower = "bottom"
rows = 3
"""
IN_TANK = """
title = "A tank"
kind = "measured"
source = "a report"
structure = "tank.toml"
collar = "held"
laws = ["loland", "morison"]
spin_up_s = 30.0
duration_s = 10.0
[tolerance.net_drag_n]
share = 0.1
reason = "the tank's own"
[tolerance."rise_m:bottom/6"]
share = 0.1
reason = "the ruler's"
"""


def test_a_structure_of_any_topology_is_a_case_too(tmp_path):
    (tmp_path / "tank.toml").write_text(TANK)
    (tmp_path / "case.toml").write_text(IN_TANK)
    (tmp_path / "measured.csv").write_text(
        "current_speed_m_s,net_drag_n,rise_m:bottom/6\n0.2,20,\n0.4,70,0.4\n"
    )
    slow, fast, rise = rows_of_case(read_case(tmp_path))
    assert 0.0 < slow.ours[0] < slow.ours[1] < fast.ours[1] < 4.0 * slow.ours[1]
    assert 0.0 < rise.ours[0] < rise.ours[1] < 1.4


def test_a_place_that_a_structure_lacks_is_refused(tmp_path):
    (tmp_path / "tank.toml").write_text(TANK)
    (tmp_path / "case.toml").write_text(IN_TANK)
    (tmp_path / "measured.csv").write_text("current_speed_m_s,rise_m:bottom/8\n0.2,1\n")
    with pytest.raises(InputError, match="a spoke from 0 to 7 as top/0; rings are: top, bottom"):
        read_case(tmp_path)


def test_waves_are_simulated_and_their_means_taken():
    cage = Cage.named("ace")
    seas = [
        SeaState(current_speed=0.2, current_to=0.0),
        SeaState(current_speed=0.2, current_to=0.0, hs=1.0),
    ]
    waters = [Water(sea=sea) for sea in seas]
    calm, wavy = answers(cage, waters, "loland", replace(HOW, spin_up=10.0, duration=2.0))
    assert wavy.net_force[1] > calm.net_force[1]
    np.testing.assert_allclose(calm.rest, rest_shape(cage, hold_collar=True), atol=0.02)
