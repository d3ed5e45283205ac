"""A cage file says what every number means, and a wrong one is refused by its key."""

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError, NonsenseError

ACE = Cage.named("ace")
TEXT = ACE.to_toml()


def refusal(text: str) -> str:
    with pytest.raises(InputError) as caught:
        Cage.from_toml(text, source="mine.toml")
    return str(caught.value)


def edited(old: str, new: str) -> str:
    assert TEXT.count(old) == 1
    return TEXT.replace(old, new)


def test_what_is_written_is_read_back(tmp_path):
    ACE.write(tmp_path / "mine.toml")
    assert Cage.read(tmp_path / "mine.toml") == ACE


def test_a_changed_cage_is_read_back_too():
    changed = ACE.rotated(11.3).fouled(shallow=0.07, deep=0.02).refined()
    assert Cage.from_toml(changed.to_toml()) == changed


def test_a_cage_without_sensors_is_read_back_too():
    without = Cage.from_toml(
        TEXT[: TEXT.index("# A load shackle")].replace(
            "heading_deg", "shackle = []\ndepth_sensor = []\nheading_deg"
        )
    )
    assert without.sensor_names == ()
    assert Cage.from_toml(without.to_toml()) == without


def test_a_name_with_quotes_and_line_breaks_is_read_back():
    odd = Cage.from_toml(edited('name = "ace"', r'name = "the \"old\" \\ one\n№ 2"'))
    assert odd.name == 'the "old" \\ one\n№ 2'
    assert Cage.from_toml(odd.to_toml()) == odd


def test_numbers_from_numpy_are_written_as_plain_ones():
    cage = ACE.altered(mesh={"spokes": np.int64(8)}, tip={"weight_n": np.float64(500.0)})
    assert Cage.from_toml(cage.to_toml()) == cage


def test_the_shipped_file_is_as_the_project_writes_it(pytestconfig):
    file = pytestconfig.rootpath / "src" / "seacage" / "cage" / "cages" / "ace.toml"
    shipped = file.read_text("utf-8")
    assert shipped[shipped.index("name = ") :] == TEXT


def test_every_parameter_has_its_unit_and_meaning():
    for line in TEXT.splitlines():
        if " = " in line and not line.startswith(("name", "heading")):
            assert re.search(r"# \S+", line), line
    units = {"m", "n", "kg", "deg", "pa", "m2", "m3"}
    bare = {"spokes", "pipes", "drag_coefficient", "submerged_fraction", "added_mass_coefficient"}
    bare |= {
        "damping_ratio",
        "corner_damping_ratio",
        "fouling_shallow",
        "fouling_deep",
        "per_corner",
        "material_factor",
        "brackets",
        *(f"{part}tn_{what}" for part in ("", "rope_") for what in ("slope", "intercept")),
        "rope_material_factor",
    }
    for section in tomllib.loads(TEXT).values():
        for key in section if isinstance(section, dict) else ():
            assert key in bare or key.rsplit("_", 1)[-1] in units, key


def test_what_a_table_is_stands_once_before_an_array_of_them():
    assert TEXT.count("# A load shackle") == 1
    assert TEXT.count("# A depth sensor") == 1
    assert TEXT.count("[[shackle]]") == 5


def test_a_misspelt_key_is_refused_with_the_one_that_was_meant():
    message = refusal(edited("weight_n = 980.0", "weight_nn = 980.0"))
    assert message == "mine.toml, tip: unknown key 'weight_nn'; did you mean 'weight_n'?"


def test_a_key_without_its_unit_is_refused_with_the_one_that_has_it():
    assert "unknown key 'radius'; did you mean 'radius_m'?" in refusal(edited("radius_m", "radius"))


def test_an_unlikely_key_is_refused_with_those_that_are_known():
    message = refusal(edited("weight_n = 980.0", "xyz = 1\nweight_n = 980.0"))
    assert message == "mine.toml, tip: unknown key 'xyz'; known are: weight_n."


def test_a_missing_key_is_refused_with_its_meaning():
    message = refusal(edited("tip_depth_m", "# tip_depth_m"))
    assert message == (
        "mine.toml, mesh: the key 'tip_depth_m' is missing (depth of the cone's tip). Add it."
    )


def test_a_missing_section_is_refused():
    tip, after = TEXT.index("[tip]"), TEXT.index("[frame]")
    assert "mine.toml: the key 'tip' is missing" in refusal(TEXT[:tip] + TEXT[after:])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("radius_m = 25.0", 'radius_m = "25"', "collar, radius_m: must be a number, not '25'."),
        ("radius_m = 25.0", "radius_m = true", "collar, radius_m: must be a number, not True."),
        ("spokes = 32", "spokes = 32.5", "mesh, spokes: must be a whole number, not 32.5."),
        ('name = "ace"', "name = 3", "mine.toml, name: must be text, not 3."),
        ("ring_depths_m = [0.0", 'ring_depths_m = ["top"', "must be a number, not 'top'."),
    ],
)
def test_a_value_of_another_kind_is_refused_by_its_key(old, new, message):
    assert message in refusal(edited(old, new))


def test_a_number_where_a_section_should_be_is_refused():
    tip, after = TEXT.index("[tip]"), TEXT.index("[frame]")
    text = "tip = 3\n" + TEXT[:tip] + TEXT[after:]
    assert "mine.toml, tip: must be a table, not 3." in refusal(text)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            "radius_m = 25.0",
            "radius_m = 0.0",
            "Collar: radius_m = 0 must be a finite number above 0",
        ),
        ("radius_m = 25.0", "radius_m = nan", "Collar: radius_m = nan must be a finite number"),
        ("radius_m = 25.0", "radius_m = inf", "Collar: radius_m = inf must be a finite number"),
        ("spokes = 32", "spokes = 2", "Mesh: spokes = 2 must be a finite number at least 3"),
        ("weight_n = 980.0", "weight_n = -1.0", "Tip: weight_n = -1 must be a finite number"),
        ("heading_deg = 0.0", "heading_deg = nan", "Cage ace: heading_deg = nan must be a finite"),
        ("[0.0, 3.5,", "[0.0, nan,", "Mesh: ring_depths_m = nan must be a finite number"),
        ("bridle = 7 ", "bridle = 0 ", "ShackleEntry: bridle = 0 must be a finite number at"),
    ],
)
def test_a_number_out_of_its_bounds_is_refused_with_the_bound(old, new, expected):
    message = refusal(edited(old, new))
    assert expected in message
    assert "It is: " in message  # and with what the number means


@pytest.mark.parametrize(
    "depths", ["[0.0]", "[1.0, 15.0]", "[0.0, 15.0, 7.0]", "[0.0, 15.0, 40.0]"]
)
def test_rings_that_do_not_go_down_from_the_surface_to_the_tip_are_refused(depths):
    shipped = TEXT[TEXT.index("ring_depths_m") : TEXT.index(" # depth of each ring")]
    assert "must start at 0 and grow to the tip" in refusal(
        edited(shipped, f"ring_depths_m = {depths}")
    )


def test_a_cylinder_that_ends_between_rings_is_refused():
    assert "cylinder_depth_m = 14 is no ring's depth" in refusal(
        edited("cylinder_depth_m = 15.0", "cylinder_depth_m = 14.0")
    )


def test_a_net_without_holes_is_refused():
    message = refusal(edited("twine_diameter_m = 0.00285", "twine_diameter_m = 0.02"))
    assert "the solidity is 0.953" in message
    assert "half_mesh_m" in message


def test_text_that_is_no_toml_is_refused_with_its_line():
    assert re.search(r"mine\.toml: this is not TOML \(.*line 2", refusal("name = 'x'\n= 3"))


def test_a_file_that_is_not_there_is_refused_by_its_name(tmp_path):
    with pytest.raises(InputError, match=r"nowhere\.toml: the file cannot be read"):
        Cage.read(tmp_path / "nowhere.toml")


def test_a_file_that_is_no_text_is_refused(tmp_path):
    (tmp_path / "photo.toml").write_bytes(b"\xff\xd8\xff")
    with pytest.raises(InputError, match=r"photo\.toml: .*no UTF-8 text"):
        Cage.read(tmp_path / "photo.toml")


def test_an_unknown_name_is_refused_with_the_known_ones():
    with pytest.raises(InputError, match="no cage 'moon'; there are: ace"):
        Cage.named("moon")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("water_depth_m = 191.0", "water_depth_m = 22.0", "hangs 31 m deep in water of 22 m"),
        ("water_depth_m = 191.0", "water_depth_m = 31.0", "water_depth_m, tip_depth_m and the"),
        ("\ndepth_m = 8.0", "\ndepth_m = 200.0", "it hangs 200 m deep in water of 191 m"),
        ("side_m = 85.0", "side_m = 40.0", "no room for a collar of radius_m = 25"),
        ("side_m = 85.0", "side_m = 50.0", "a side is 25 m from the centre"),
        ("bearings_deg = [67.5, ", "bearings_deg = [", "11 bearings_deg but 12 length_offset_m"),
        ("radius_m = 25.0", "radius_m = nan", "radius_m = nan must be a finite number"),
        ("\ntn_slope = 3.0", "", "tn_intercept = 178 says nothing without tn_slope"),
    ],
)
def test_a_file_that_makes_no_sense_is_refused_with_its_name(tmp_path, old, new, message):
    path = tmp_path / "mine.toml"
    path.write_text(edited(old, new))
    with pytest.raises(NonsenseError, match=f"^{path}: .*{message}"):
        Cage.read(path)


def test_half_of_a_rope_s_strength_is_refused():
    frame = Cage.named("ace").frame
    with pytest.raises(InputError, match="rope_breaking_load_n = 627000 says nothing without"):
        replace(frame, rope_material_factor=None)
    with pytest.raises(InputError, match="rope_tn_intercept = 178 says nothing without rope_break"):
        replace(frame, rope_material_factor=None, rope_breaking_load=None)


def test_a_file_that_goes_deep_is_refused(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("a = " + "[" * 100_000)
    with pytest.raises(InputError, match=r"mine\.toml: this is not TOML \(its parts lie more than"):
        Cage.read(path)


def test_a_cage_is_the_same_cage_as_in_version_0_1():
    # Comments count: campaigns and fields of that version go on only with the same text.
    known = "df814a7d1366bea6c5fe9087ec906517ea8b63224150e49c513310dd4fd8ecdd"
    # of `ace` since; a file need not have them
    newer = ("pipe_distance_m = ", "brackets = ", "pretension_sd_n = ", "length_sd_m = ")
    newer += ("rope_slack_sd_m = ", "rope_tn_", "rope_breaking_", "rope_material_", "tn_")
    lines = [line for line in TEXT.splitlines(keepends=True) if not line.startswith(newer)]
    assert Cage.from_toml("".join(lines)).sha256 == known
