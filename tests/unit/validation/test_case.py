"""A user's case: one TOML, one CSV, and a clear sentence where one of them is wrong."""

import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import settle
from seacage.ocean import SeaState
from validation import Kind
from validation._case import CASES, read_case, read_cases
from validation.own_cases import rows_of_case

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
    assert (case.title, case.kind, case.hold_collar) == ("A tank", Kind.MEASURED, True)
    assert [cage.tip.weight for cage in case.cages] == [2000.0]
    read = [(m.sea.current_speed, m.quantity.name, m.value, m.uncertainty) for m in case.measured]
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


def test_an_ensemble_spans_every_combination_and_law(folder):
    ensemble = '[ensemble]\n"tip.weight_n" = [500.0, 5000.0]\n'
    (folder / "case.toml").write_text(
        TOML.replace('["loland"]', '["loland", "aarsnes"]') + ensemble
    )
    (folder / "measured.csv").write_text("current_speed_m_s,net_drag_kn\n0.3,25\n")
    case = read_case(folder)
    assert [cage.tip.weight for cage in case.cages] == [500.0, 5000.0]
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


def test_the_cases_that_come_with_seacage_are_read():
    names = [case.name for case in read_cases()]
    assert names == sorted(path.parent.name for path in CASES.glob("*/case.toml"))
    assert "held_collar_model" in names


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("title =", "titel =", "key 'title' is missing"),
        ('cage = "ace"', 'cage = "ace"\ncolour = 3', "key 'colour' is unknown"),
        ('"measured"', '"mesured"', "kind 'mesured' is unknown; did you mean 'measured'?"),
        ('"held"', '"hold"', "collar 'hold' is unknown; did you mean 'held'?"),
        ('["loland"]', '["lolland"]', "laws 'lolland' is unknown; did you mean 'loland'?"),
        ('["loland"]', "3", "laws must be a list, not 3"),
        ('"ace"', '"mine.toml"', "there is no cage file mine.toml beside it"),
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
def test_a_wrong_toml_is_refused_in_one_sentence(folder, old, new, said):
    assert old in TOML
    (folder / "case.toml").write_text(TOML.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        read_case(folder)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("speed,net_drag_kn\n0.2,3\n", "the column current_speed_m_s is missing"),
        ("current_speed_m_s,drag\n0.2,3\n", "column 'drag' is no quantity. Known are: net_drag_kn"),
        ("current_speed_m_s,net_drag_kn\n0.2,3\n0.3,x\n", "line 3: net_drag_kn = 'x' is no number"),
        ("current_speed_m_s,rise_m:top\n0.2,3\n", "'top' is no place of the cage. Write tip"),
        ("current_speed_m_s,depth_m:10:3\n0.2,3\n", "rings 0 to 9 and spokes 0 to 31"),
        ("current_speed_m_s,bridle_tension_kn:13\n0.2,3\n", "the cage has bridles 1 to 12"),
        ("current_speed_m_s,uncertainty:net_drag_kn\n0.2,3\n", "'uncertainty:net_drag_kn' is unk"),
        ("current_speed_m_s,net_drag_kn\n9,3\n", "current_speed = 9 m/s is above 3 m/s"),
    ],
)
def test_a_wrong_csv_is_refused_in_one_sentence(folder, text, said):
    (folder / "measured.csv").write_text(text)
    with pytest.raises(InputError) as caught:
        read_case(folder)
    assert said in str(caught.value)


def test_a_case_without_numbers_is_refused(folder):
    (folder / "measured.csv").unlink()
    with pytest.raises(InputError, match=r"measured\.csv is missing beside"):
        read_case(folder)


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("net_lift_kn", lambda r, _: r.net_force[2] / 1e3),
        ("volume_m3", lambda r, _: r.volume),
        ("volume_loss_percent", lambda r, _: 100.0 * (1.0 - r.volume_fraction)),
        (
            "design_volume_loss_percent",
            lambda r, cage: 100.0 * (1.0 - r.volume / cage.volume(cage.design_position)),
        ),
        ("depth_m:depth-2", lambda r, cage: -r.node_position[cage.depth_sensors[1].node, 2]),
        ("depth_m:5:24", lambda r, cage: -r.node_position[cage.node(5, 24), 2]),
        ("design_rise_m:tip", lambda r, cage: r.node_position[cage.bottom_node, 2] + 31.0),
        ("bridle_tension_kn:7", lambda r, _: r.bridle_tension[6] / 1e3),
    ],
)
def test_each_quantity_is_read_as_its_name_says(folder, column, value):
    from validation._quantities import quantity_named

    cage = Cage.named("ace")
    sea = SeaState(current_speed=0.2, current_to=0.0)
    response = settle(cage, sea, hold_collar=True)
    found = quantity_named(column, cage, "here").read(response, sea)
    assert found == pytest.approx(float(value(response, cage)))
