"""A small bench from cages to page: rows, seal, another's row, and what is refused."""

import json
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest
from typer.testing import CliRunner

from seacage.cage import Cage
from seacage.campaigns import generated_current
from seacage.conventions import InputError
from seacage.records import write_record
from seacage.service._cli._app import app
from seacage.studies import BenchStudy, bench_study
from seacage.studies._bench import _rows, _study
from seacage.studies._bench._cases import START, Given, Size
from seacage.twin import Training

COARSE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
SMALL = replace(COARSE, shackle=COARSE.shackle[:1], depth_sensor=COARSE.depth_sensor[:2])
SIZE = Size(cage=SMALL, cases=60, wave_cases=24, days=12.0, nets=5, stretches=3, seas=8)
OPTIONS = {"truths": (1,), "waters": ("coastal",), "workers": 1}

# All stand on a study that is made whole.
pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("bench")


@pytest.fixture(scope="module", autouse=True)
def small():
    training = Training(high_fidelity_points=60, restarts=0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(_study, "_size", lambda **_: SIZE)
        patch.setattr(_rows, "TRAINING", training)
        patch.setattr("seacage.studies._bench._stretches.WATCH_DAYS", 6)
        yield


@pytest.fixture(scope="module")
def study(folder) -> BenchStudy:
    return bench_study(folder, **OPTIONS)


def refuse_again(stage, done, total):
    assert stage in {"cases", "rows"}, f"{stage} was made again"


def test_five_tasks_have_their_rows_and_every_number_is_of_a_virtual_field(study):
    found = json.loads(study.scores.read_text())
    assert found["origin"] == "virtual field"
    rows = {}
    for one in found["scores"]:
        rows.setdefault(one["task"], set()).add(one["row"])
        assert np.isfinite(one["error"])
    trees = {"boosted trees"} if find_spec("sklearn") else set()
    learners = {"seacage", "sensor alone", "AR1"}
    assert rows == {
        "load": {*learners, "low fidelity", "linear", *trees},
        "peak": {"seacage", "low fidelity", "mean load alone", "sea-state regression"},
        "shape": {"seacage", "low fidelity"},
        "alarm": {"seacage", "three-sigma limit"},
        "calibration": learners,
    }
    page = study.report.read_text()
    assert page.count("data:image/svg+xml") == 5
    assert "Virtual field" in page


def test_a_learner_is_given_nothing_of_the_truth(study):
    ((name, given),) = study.cases.items()
    assert name.startswith("coastal-1-")
    assert {path.name for path in given.iterdir()} == {"field", "waves", "queries.npz"}
    case = Given(folder=given, cage=SMALL)
    cut = case.queries["time"][0]
    assert all(one.time[-1] < cut for one in case.field.sensors.values())
    sealed = np.load(given.parent / "sealed.npz")
    assert not set(sealed.files) & set(case.queries)
    assert sealed["tension_kn"].shape == case.shapes["mean_kn"]
    assert sealed["node_m"].shape == case.shapes["node_m"]


def test_a_run_again_makes_nothing_again_and_the_same_numbers(study, folder):
    before = study.scores.read_text()
    bench_study(folder, progress=refuse_again, **OPTIONS)
    assert study.scores.read_text() == before


def test_another_method_joins_by_a_folder_of_predictions(study, folder, tmp_path):
    ((name, given),) = study.cases.items()
    case = Given(folder=given, cage=SMALL)
    (tmp_path / "mine").mkdir()
    path = tmp_path / "mine" / f"{name}.npz"
    np.savez(path, mean_kn=np.full(case.shapes["mean_kn"], 20.0))
    words = ["study", "bench", "--out", str(folder), "--truths", "1", "--water", "coastal"]
    words += ["--row", str(path.parent), "--json"]
    result = CliRunner().invoke(app, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    (mine,) = (one for one in json.loads(result.stdout)["means"] if one["row"] == "mine")
    truth = np.load(given.parent / "sealed.npz")["tension_kn"]
    assert mine["task"] == "load"
    assert mine["error"] == pytest.approx(np.abs(20.0 - truth).mean())
    with pytest.raises(InputError, match="already"):
        bench_study(folder, rows=[path.parent.rename(tmp_path / "seacage")], **OPTIONS)
    with pytest.raises(InputError, match=f"no predictions for the case {name}"):
        bench_study(folder, rows=[tmp_path], **OPTIONS)


def test_without_scikit_learn_its_row_is_left_out_in_a_sentence(study, folder, monkeypatch):
    monkeypatch.setattr(_rows, "find_spec", lambda _: None)
    monkeypatch.setattr(_study, "find_spec", lambda _: None)
    found = bench_study(folder, **OPTIONS)
    assert "boosted trees" not in {one.row for one in found.means}
    assert "pip install &#39;seacage[bench]&#39;" in found.report.read_text()


def test_what_cannot_be_a_bench_is_refused(folder, tmp_path):
    record = generated_current(1, start=START, days=3.0)
    write_record(record, tmp_path / "short.nc")
    with pytest.raises(InputError, match=r"spans 3\.0 days, and half of them train"):
        bench_study(folder, current=tmp_path / "short.nc", **OPTIONS)
    with pytest.raises(InputError, match="Truth 101 is sealed"):
        bench_study(folder, **{**OPTIONS, "truths": (101,)})
    with pytest.raises(InputError, match="No surrogate 'none'"):
        bench_study(folder, surrogates=["none"], **OPTIONS)
