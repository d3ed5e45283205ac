"""The hidden parameters."""

import hashlib
import re
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import seacage
from seacage.cage import Cage
from seacage.campaigns import Hidden
from seacage.conventions import InputError

TEXT = (resources.files("seacage.campaigns") / "hidden_ace.toml").read_text("utf-8")


def test_the_file_that_comes_with_seacage_is_read_with_its_hash() -> None:
    hidden = Hidden.read()
    assert hidden.sha256 == hashlib.sha256(TEXT.encode()).hexdigest()
    assert hidden.law == "loland"


def test_one_changed_character_changes_the_hash(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(TEXT + "\n")
    assert Hidden.read(tmp_path / "mine.toml").sha256 != Hidden.read().sha256


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (TEXT.replace("growth_days", "grwth_days"), "'growth_days' is missing"),
        (TEXT + "colour = 3\n", "'colour' is unknown"),
        (TEXT.replace("= 24.0", '= "late"'), "cleaned_day: 'late' is no finite number"),
        (TEXT.replace("= 24.0", "= nan"), "cleaned_day: nan is no finite number"),
        (re.sub(r"\[netting\]\n.*\n", "netting = 3\n", TEXT), "is unknown|is missing"),
        (TEXT.replace('"loland"', '"lolland"'), "'lolland' is none of"),
        ("law = ", "as TOML"),
    ],
)
def test_a_wrong_file_is_refused(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(InputError, match=says):
        Hidden.read(tmp_path / "mine.toml")


def test_no_room_that_learns_names_the_hidden_parameters() -> None:
    package = Path(seacage.__file__).parent
    learning = [*package.glob("surrogates/*.py"), *package.glob("twin/*.py")]
    assert learning
    for source in learning:
        text = source.read_text("utf-8")
        assert "Hidden" not in text, source
        assert "hidden_ace" not in text, source
        assert "seacage.campaigns" not in text, source


def test_fouling_grows_until_the_net_is_cleaned_and_again() -> None:
    fouling = Hidden.read().fouling
    day = np.linspace(0.0, 48.0, 481)
    grown = fouling.grown(day)
    before = day < fouling.cleaned_day
    assert np.all(np.diff(grown[before]) > 0.0)
    assert np.all(np.diff(grown[~before]) > 0.0)
    assert grown[before][-1] > 0.9
    assert grown[~before][0] < 0.1
    assert grown.min() >= 0.0
    assert grown.max() <= 1.0


def test_the_true_cage_is_grown_stiffer_and_uneven() -> None:
    hidden, drawn = Hidden.read(), Cage.named("ace")
    clean, grown = hidden.true_cage(drawn, 0.0), hidden.true_cage(drawn, 1.0)
    assert clean.netting.fouling_shallow == pytest.approx(0.03)
    assert grown.netting.fouling_shallow == pytest.approx(0.10)
    assert grown.netting.fouling_deep < grown.netting.fouling_shallow
    assert grown.netting.elastic_modulus > drawn.netting.elastic_modulus
    assert 0.05 < np.std(grown.bridles.length_offset) < 0.3
    assert grown.bridles.length_offset == clean.bridles.length_offset
