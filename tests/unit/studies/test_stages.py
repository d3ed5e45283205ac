"""Stages that are made once."""

import json

import pytest

from seacage.conventions import RecordError
from seacage.studies._stages import Stages, code_sha256

ROOMS = ("conventions",)


@pytest.fixture
def stages(tmp_path) -> Stages:
    return Stages(folder=tmp_path)


def write_answer(begun):
    (begun / "answer").write_text("42")


def never(begun):
    raise AssertionError("was made again")


def test_a_stage_is_made_once(stages):
    first = stages.ensure("field", {"seed": 1}, write_answer, rooms=ROOMS)
    assert (first / "answer").read_text() == "42"
    assert stages.ensure("field", {"seed": 1}, never, rooms=ROOMS) == first


def test_other_settings_make_another_stage_and_leave_the_first(stages):
    first = stages.ensure("field", {"seed": 1}, write_answer, rooms=ROOMS)
    second = stages.ensure("field", {"seed": 2}, write_answer, rooms=ROOMS)
    assert first != second
    assert first.exists()


def test_other_code_makes_another_stage(stages):
    first = stages.ensure("field", {}, write_answer, rooms=("conventions",))
    assert stages.ensure("field", {}, write_answer, rooms=("ocean",)) != first
    assert code_sha256(("conventions",)) == code_sha256(("conventions",))


def test_a_stop_in_between_finishes_nothing_and_loses_nothing(stages):
    def stopped(begun):
        (begun / "half").write_text("so far")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stages.ensure("field", {}, stopped, rooms=ROOMS)

    def resumed(begun):
        assert (begun / "half").read_text() == "so far"
        write_answer(begun)

    finished = stages.ensure("field", {}, resumed, rooms=ROOMS)
    assert [path.name for path in stages.folder.iterdir()] == [finished.name]


def test_the_manifest_says_what_the_stage_was_made_from(stages):
    folder = stages.ensure("field", {"seed": 1}, write_answer, rooms=ROOMS)
    manifest = json.loads((folder / "stage.json").read_text())
    assert manifest["stage"] == "field"
    assert manifest["settings"] == {"seed": 1}
    assert manifest["code_sha256"] == code_sha256(ROOMS)


def test_a_stage_that_was_tampered_with_is_refused(stages):
    folder = stages.ensure("field", {}, write_answer, rooms=ROOMS)
    (folder / "stage.json").write_text("{}")
    with pytest.raises(RecordError, match="Delete this folder"):
        stages.ensure("field", {}, write_answer, rooms=ROOMS)
