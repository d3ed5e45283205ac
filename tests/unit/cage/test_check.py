"""A cage's file is checked whole: every error by its line, and what is odd besides."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage, cage_errors, cage_numbers, cage_remarks
from seacage.cage._toml import lines_of
from seacage.conventions import InputError, NonsenseError

ACE = Cage.named("ace")
TEXT = ACE.to_toml()


def errors(*edits: tuple[str, str]) -> list[tuple[str, str]]:
    """The line itself and the sentence, of every error."""
    text = TEXT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new, 1)
    lines = text.splitlines()
    return [(lines[e.line - 1], e.sentence) for e in cage_errors(text, source="mine.toml")]


def remarks(cage: Cage) -> list[tuple[str, str]]:
    """The key of the line and the sentence, of every remark."""
    text = cage.to_toml()
    lines = text.splitlines()
    return [(lines[one.line - 1].split(" =")[0], one.sentence) for one in cage_remarks(cage, text)]


def test_a_cage_that_is_right_has_no_errors_and_nothing_odd():
    assert errors() == []
    assert remarks(ACE) == []


def test_all_that_is_wrong_is_named_at_once_each_by_its_line():
    found = errors(
        ("heading_deg = 0.0", "heading_deg = nan"),
        ("side_m = 85.0", "side_m = -85.0"),
        ("pretension_n = 10000.0", 'pretension_n = "10 kN"'),
        ("depth_m = 7.0", "depht_m = 7.0"),
        ("spokes = 32", "spokes = 3.5"),
    )
    assert [line.split(" #")[0].strip() for line, _ in found] == [
        "heading_deg = nan",
        "spokes = 3.5",
        "side_m = -85.0",
        'pretension_n = "10 kN"',
        "[[depth_sensor]]",
        "depht_m = 7.0",
    ]
    sentences = [sentence for _, sentence in found]
    assert sentences[0].startswith("heading_deg = nan must be a finite number")
    assert sentences[1] == "mesh, spokes: must be a whole number, not 3.5."
    assert sentences[2] == (
        "frame: side_m = -85 must be a finite number above 0. It is: length of a side."
    )
    assert sentences[3] == "bridles, pretension_n: must be a number, not '10 kN'."
    assert "'depth_m' is missing (in the design shape)" in sentences[4]
    assert "did you mean 'depth_m'?" in sentences[5]


@pytest.mark.parametrize(
    ("old", "new", "line", "sentence"),
    [
        ("[tip]", "[top]", "name =", "the key 'tip' is missing"),
        ("[tip]", "[[tip]]", "weight_n = 980", "tip: must be a table"),
        ("bridle = 7", "bridle = 77", "bridle = 77", "there are 12"),
        ("bridle = 9", "bridle = 99", "bridle = 99", "shackle-3 sits on bridle 99"),
        (
            "twine_diameter_m = 0.0",
            "twine_diameter_m = 0.05",
            "twine_diameter_m",
            "the solidity is",
        ),
        ("water_depth_m = 191", "water_depth_m = 20", "water_depth_m = 20", "no bed carries it"),
        ("cylinder_depth_m = 15", "cylinder_depth_m = 14", "cylinder_depth_m", "no ring's depth"),
        ("tip_depth_m = 31.0", "tip_depth_m = inf", "tip_depth_m = inf", "finite number above 0"),
        ("ring_depths_m = [0.0,", "ring_depths_m = [true,", "ring_depths_m", "not True"),
        ("side_m = 85.0", "side_m = 40.0", "radius_m", "no room for a collar"),
    ],
)
def test_an_error_is_found_where_it_stands(old, new, line, sentence):
    ((found, why),) = (one for one in errors((old, new)) if "unknown key" not in one[1])
    assert found.startswith(line)
    assert sentence in why


def test_whatever_is_refused_has_an_error_and_nothing_else_has():
    """Each key in turn becomes text, NaN and negative."""
    lines = TEXT.splitlines()
    for number, line in enumerate(lines):
        key, equals, _ = line.partition(" = ")
        for value in ('"text"', "nan", "-1e9", "[]") if equals and key[:1] != "#" else ():
            text = "\n".join([*lines[:number], f"{key} = {value}", *lines[number + 1 :]])
            try:
                Cage.from_toml(text)
            except InputError:
                assert cage_errors(text, source="mine.toml"), (key, value)
            else:
                assert not cage_errors(text, source="mine.toml"), (key, value)


def test_another_file_is_refused_in_one_sentence():
    with pytest.raises(InputError, match=r"mine\.toml: this is not TOML"):
        cage_errors("time,depth\n1,2\n", source="mine.toml")
    with pytest.raises(NonsenseError, match="a structure of rings"):
        cage_errors("ring = 3", source="mine.toml")
    (first, *others) = cage_errors("port = 8000", source="mine.toml")
    assert first.line == 1
    assert len(others) > 10


NOTHING = {"sinker_tube": {"weight_n_m": 0.0}, "tip": {"weight_n": 0.0}}
ODD = [
    ({"site": {"water_depth_m": 32.5}}, "water_depth_m", "leaves 1.5 m below"),
    ({"site": {"latitude_deg": 8.7, "longitude_deg": 63.7}}, "latitude_deg", "swapped"),
    ({"collar": {"pipe_mass_kg_m": 300.0}}, "pipe_mass_kg_m", "the collar sinks"),
    ({"sinker_tube": {"weight_n_m": 2000.0}}, "weight_n_m", "more than 60 %"),
    (NOTHING | {"netting": {"mass_kg_m2": 0.0}}, "weight_n_m", "does not hang"),
    ({"bridles": {"chain_length_m": 38.0}}, "chain_length_m", "longer than the shortest bridle"),
    ({"bridles": {"pretension_n": 2e5}}, "pretension_n", "160000 N"),
    ({"bridles": {"length_offset_m": [0.5] + [0.0] * 11}}, "length_offset_m", "bridle-1 hangs"),
    ({"anchor_lines": {"rope_length_m": 20.0}}, "rope_length_m", "do not reach"),
    ({"netting": {"twine_diameter_m": 0.001}}, "twine_diameter_m", "the solidity is 0.0769"),
    ({"netting": {"fouling_deep": 0.4}}, "twine_diameter_m", "the solidity is 0.611"),
    (
        {"bridles": {"bearings_deg": [45.0, 135.0, 225.0], "length_offset_m": [0.0] * 3}},
        "bearings_deg",
        "no bridle comes from corner 2",
    ),
    ({"mesh": {"spokes": 8}}, "bearings_deg", "nearest of 8 spokes"),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "key", "sentence"), ODD)
def test_what_is_odd_is_remarked_on_at_its_key(changes, key, sentence):
    cage = replace(ACE, shackle=()).altered(**changes)
    assert any(at == key and sentence in one for at, one in remarks(cage)), remarks(cage)


def test_a_place_in_norway_chile_or_tasmania_is_not_odd():
    for latitude, longitude in ((63.7, 8.7), (-42.0, -73.0), (-43.0, 147.0), (35.0, 26.0)):
        place = {"latitude_deg": latitude, "longitude_deg": longitude}
        assert not remarks(ACE.altered(site=place))


def test_a_depth_sensor_far_from_every_node_is_remarked_on():
    far = replace(ACE.depth_sensor[1], depth=40.0)
    cage = replace(ACE, depth_sensor=(ACE.depth_sensor[0], far))
    ((key, sentence),) = remarks(cage)
    assert key == "depth_m"
    assert "depth-2 at depth_m = 40 sits on the nearest node, 31 m deep" in sentence


def test_derived_numbers_are_those_of_a_cylinder_over_a_cone():
    numbers = cage_numbers(ACE)
    whole = np.pi * 25.0**2 * (15.0 + 16.0 / 3.0)
    # The polygon of 32 spokes has 0.6 % less area than the circle.
    assert numbers["volume_m3"] == pytest.approx(whole, rel=0.008)
    assert numbers["netting_area_m2"] == pytest.approx(np.pi * 25.0 * (30.0 + np.hypot(25.0, 16.0)))
    assert numbers["water_below_m"] == pytest.approx(160.0)
    assert (numbers["nodes"], numbers["bridles"], numbers["lines"]) == (321, 12, 28)


def test_lines_are_those_of_sections_keys_and_numbered_tables():
    lines = lines_of("a = 1\n[b]\n# c = 2\nc = 3\n[[d]]\ne = 4\n[[d]]\ne = 5\n")
    assert lines == {
        (): 1,
        ("a",): 1,
        ("b",): 2,
        ("b", "c"): 4,
        ("d",): 5,
        ("d", 0): 5,
        ("d", 0, "e"): 6,
        ("d", 1): 7,
        ("d", 1, "e"): 8,
    }
