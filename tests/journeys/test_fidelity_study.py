"""A virtual field is held against its rules, through every stage, from the shell too."""

import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from seacage.cage import Cage
from seacage.conventions import InputError, Origin
from seacage.records import FieldRecord
from seacage.service._cli._app import app
from seacage.studies import FidelityStudy, fidelity_study
from seacage.studies._fidelity import _study
from stand_in import StandIn

COARSE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
SMALL = replace(COARSE, shackle=COARSE.shackle[:1], depth_sensor=COARSE.depth_sensor[:2])

# All stand on a study that is made whole.
pytestmark = pytest.mark.slow


def refuse_again(stage, done, total):
    assert stage in {"rescaling", "null case", "fouling"}, f"{stage} was made again"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fidelity")


@pytest.fixture(scope="module", autouse=True)
def stand_in():
    """Settle by a formula, whatever the cage, on a field of a few days."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.settle", StandIn().settle)
        patch.setattr(Cage, "named", lambda _: SMALL)
        patch.setattr(_study, "_DAYS", 10.0)
        patch.setattr(_study, "_POINTS", 60)
        patch.setattr("seacage.studies._fidelity._rescaling._CURRENTS", 60)
        yield


@pytest.fixture(scope="module")
def study(folder) -> FidelityStudy:
    return fidelity_study(folder, windows=120, seed=3, workers=1)


@pytest.fixture
def field(study, folder):
    """The field that the study made for itself."""
    (made,) = (folder / "stages").glob("field-*")
    record, truth = (FieldRecord.read(made / part) for part in ("field", "truth"))
    return record, truth


def test_each_claim_has_its_verdict_and_every_sensor_its_numbers(study):
    assert [claim.verdict for claim in study.claims[:3]] == ["holds"] * 3
    assert [gap.sensor for gap in study.gaps] == list(SMALL.sensor_names)
    assert [one.sensor for one in study.rescalings] == list(SMALL.sensor_names)
    assert {one.sensor for one in study.null.real.sensors} == set(SMALL.sensor_names)
    assert study.null.real.together.low > 0.0
    assert study.null.null.together.low <= 0.0, "nothing is gained where there is nothing to gain"


def test_the_nets_are_compared_with_and_without_the_drift_of_the_cage(study):
    fouling = study.fouling
    assert fouling.distance.shape == fouling.distance_without_drift.shape == (5, 3)
    assert np.all(fouling.distance > 0.0)
    scores = json.loads(study.scores.read_text("utf-8"))["fouling"]
    np.testing.assert_allclose(scores["distance_without_drift"], fouling.distance_without_drift)


def test_the_page_stands_alone_and_says_what_is_virtual(study):
    page = study.report.read_text("utf-8")
    assert page.count("data:image/svg+xml") == 4
    for claim in study.claims:
        assert claim.claim.split(" ", 1)[0] in page
    assert page.count(">holds<") + page.count(">missed<") == len(study.claims)
    assert "virtual field" in page
    assert "http" not in page
    assert study.report.stat().st_size < 3e6


def test_the_numbers_behind_the_page_can_be_read_by_a_program(study):
    scores = json.loads(study.scores.read_text("utf-8"), parse_constant=pytest.fail)
    assert [one["claim"] for one in scores["claims"]] == [one.claim for one in study.claims]
    assert scores["sensors"][0]["bias"]["mean"] == study.gaps[0].bias.mean
    assert scores["provenance"]["Seed"] == "3"


def test_a_second_study_simulates_nothing_again_and_says_the_same(study, folder):
    page = study.report.read_bytes()
    again = fidelity_study(folder, windows=120, seed=3, workers=1, progress=refuse_again)
    assert again.report.read_bytes() == page


def test_the_shell_studies_a_field_that_is_there(study, field, tmp_path):
    field[0].write(tmp_path / "field")
    field[1].write(tmp_path / "field" / "truth")
    words = ["study", "fidelity", "--field", tmp_path / "field", "--out", tmp_path / "out"]
    words += ["--windows", "120", "--seed", "3", "--workers", "1", "--json"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.service._logs.begin_logs", lambda _: None)
        result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    answer = json.loads(result.stdout)
    assert answer["origin"] == "virtual field"
    assert [one["finding"] for one in answer["claims"]] == [one.finding for one in study.claims]


def test_a_field_that_is_not_virtual_or_of_other_hidden_parameters_is_refused(field, tmp_path):
    record, truth = field
    truth.write(tmp_path / "truth")
    replace(record, origin=Origin.MEASURED).write(tmp_path)
    with pytest.raises(InputError, match="no truth is known"):
        fidelity_study(tmp_path / "out", field=tmp_path)
    replace(record, hidden_sha256="0" * 64).write(tmp_path)
    with pytest.raises(InputError, match="Give the file that made it"):
        fidelity_study(tmp_path / "out", field=tmp_path)
