"""The hidden parameters."""

import hashlib
import re
from dataclasses import replace
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import seacage
from seacage.cage import Cage
from seacage.campaigns import TruthParameters
from seacage.conventions import InputError

TEXT = (resources.files("seacage.campaigns._virtual_field") / "hidden_ace.toml").read_text("utf-8")


def test_the_file_that_comes_with_seacage_is_read_with_its_hash() -> None:
    hidden = TruthParameters.read()
    assert hidden.sha256 == hashlib.sha256(TEXT.encode()).hexdigest()
    assert hidden.law == "loland"


def test_one_changed_character_changes_the_hash(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(TEXT + "\n")
    assert TruthParameters.read(tmp_path / "mine.toml").sha256 != TruthParameters.read().sha256


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (TEXT.replace("growth_days", "grwth_days"), "'growth_days' is missing"),
        (TEXT + "colour = 3\n", "'colour' is unknown"),
        (TEXT.replace("[24.0]", '["late"]'), "cleaned_days: 'late' is no finite number"),
        (TEXT.replace("[24.0]", "[nan]"), "cleaned_days: nan is no finite number"),
        (re.sub(r"\[netting\]\n.*\n.*\n", "netting = 3\n", TEXT), "is unknown|is missing"),
        (TEXT.replace('"loland"', '"lolland"'), "No screen law 'lolland'; there are: aarsnes"),
        ("law = ", "not TOML"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(InputError, match=says):
        TruthParameters.read(tmp_path / "mine.toml")


def test_no_room_that_learns_names_the_hidden_parameters() -> None:
    package = Path(seacage.__file__).parent
    learning = [*package.glob("surrogates/**/*.py"), *package.glob("twin/**/*.py")]
    assert learning
    for source in learning:
        text = source.read_text("utf-8")
        assert "TruthParameters" not in text, source
        assert "hidden_ace" not in text, source
        assert "seacage.campaigns" not in text, source


def test_fouling_grows_until_the_net_is_cleaned_and_again() -> None:
    fouling = replace(TruthParameters.read().fouling, cleaned_days=(24.0, 36.0))
    day = np.linspace(0.0, 48.0, 481)
    grown = fouling.grown(day)
    for first, last in ((0.0, 24.0), (24.0, 36.0), (36.0, 48.0)):
        part = grown[(day >= first) & (day < last)]
        assert np.all(np.diff(part) > 0.0)
        assert part[0] < 0.1
    assert grown[day < 24.0][-1] > 0.9
    assert grown.min() >= 0.0
    assert grown.max() <= 1.0


def test_growth_is_thicker_above_and_softer_than_a_net_as_solid() -> None:
    fouling = TruthParameters.read().fouling
    for growth, shallow, soft in ((0.0, 0.03, 1.0), (1.0, 0.10, 0.85)):
        solidity, drag = fouling.solidity_and_drag(growth, np.array([2.0, 20.0]))
        np.testing.assert_allclose(solidity, [shallow, 0.6 * shallow])
        np.testing.assert_allclose(drag, soft)


def test_the_refined_cage_has_the_drawn_nodes_where_they_were() -> None:
    hidden, drawn = TruthParameters.read(), Cage.named("ace")
    fine = hidden.fine_cage(drawn)
    assert fine.node_count == 20 * 64 + 1
    ring, spoke = np.divmod(np.arange(drawn.node_count - 1), drawn.spokes)
    same = np.append(fine.spokes * 2 * ring + 2 * spoke, fine.bottom_node)
    np.testing.assert_allclose(
        fine.design_position[same], drawn.design_position, atol=1e-9
    )  # rounding
    stiffness = [cage.spokes * cage.ropes.axial_stiffness for cage in (drawn, fine)]
    assert stiffness[0] == pytest.approx(stiffness[1])


def test_another_seed_draws_another_cage_from_the_same_ranges_and_has_another_hash() -> None:
    hidden, drawn = TruthParameters.read(), Cage.named("ace")
    cages = [hidden.drawn(seed).true_cage(drawn, 0.0) for seed in range(200)]
    tighter = np.array([cage.bridles.pretension / drawn.bridles.pretension for cage in cages])
    slack = np.array([cage.frame.rope_slack for cage in cages])
    brackets = np.array([cage.collar.brackets for cage in cages])
    for values, least, most in (
        (tighter, hidden.bridles.pretension_least, hidden.bridles.pretension_most),
        (slack, hidden.frame.slack_least_m, hidden.frame.slack_most_m),
        (brackets, hidden.collar.brackets_least, hidden.collar.brackets_most),
    ):
        assert least <= values.min() < values.max() <= most
        # 200 uniform draws: their ends miss a tenth of the range with probability 1e-9
        assert np.ptp(values) > 0.8 * (most - least)
    assert hidden.drawn(3) == hidden.drawn(3)
    assert len({hidden.sha256, hidden.drawn(3).sha256, hidden.drawn(4).sha256}) == 3


def test_the_growing_net_and_the_fine_mesh_are_of_the_same_cage() -> None:
    hidden, drawn = TruthParameters.read(), Cage.named("ace")
    fine, grown = hidden.fine_cage(drawn), hidden.true_cage(drawn, 1.0)
    assert (fine.bridles, fine.frame, fine.collar) == (grown.bridles, grown.frame, grown.collar)


def test_pipes_that_slide_in_the_drawing_slide_in_truth() -> None:
    sliding = Cage.named("ace").altered(collar={"brackets": 0})
    assert TruthParameters.read().true_cage(sliding, 0.0).collar.brackets == 0


def test_the_true_cage_is_grown_stiffer_and_uneven() -> None:
    hidden, drawn = TruthParameters.read(), Cage.named("ace")
    clean, grown = hidden.true_cage(drawn, 0.0), hidden.true_cage(drawn, 1.0)
    assert clean.netting.fouling_shallow == pytest.approx(0.03)
    assert grown.netting.fouling_shallow == pytest.approx(0.10)
    assert grown.netting.fouling_deep < grown.netting.fouling_shallow
    assert grown.netting.elastic_modulus > drawn.netting.elastic_modulus
    assert 0.05 < np.std(grown.bridles.length_offset) < 0.3
    assert grown.bridles.length_offset == clean.bridles.length_offset
