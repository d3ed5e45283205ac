"""Sea states and a current become one page and its numbers, through every stage."""

import json
from dataclasses import replace

import pytest

from seacage.cage import Cage
from seacage.studies import PaperStudy, score_record
from seacage.studies._chain import Chain, Recipe
from seacage.studies._paper import study_chain
from stand_in import StandIn

COARSE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
SMALL = replace(COARSE, shackle=COARSE.shackle[:2], depth_sensor=COARSE.depth_sensor[1:2])
RECIPE = Recipe(
    cases=60, held_out_cases=12, days=10.0, teaching_days=5, high_fidelity_points=60, seed=3
)


def chain(folder, **options) -> Chain:
    return Chain(folder=folder / "stages", cage=SMALL, recipe=RECIPE, workers=1, **options)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("study")


@pytest.fixture(scope="module", autouse=True)
def stand_in():
    """Settle by a formula: the true simulator's journey is that of the campaign."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._run.settle", StandIn().settle)
        yield


@pytest.fixture(scope="module")
def study(folder) -> PaperStudy:
    return study_chain(chain(folder), folder)


def test_every_sensor_is_scored_on_days_that_it_did_not_teach(study):
    assert [score.sensor for score in study.sensors] == list(SMALL.sensor_names)
    assert {score.origin for score in study.sensors} == {"virtual field"}
    hours = {score.unit: score.span_h for score in study.sensors}
    assert hours["m"] == pytest.approx(120.0, abs=2.0)
    assert hours["kN"] == pytest.approx(24.0, abs=2.0)


def test_level_one_is_close_to_simulations_that_it_has_not_seen(study):
    assert study.level_one.cases == 12
    share = study.level_one.bridle_mae / study.level_one.bridle_mean
    assert share.max() < 0.02


def test_the_page_stands_alone_and_says_what_is_virtual(study):
    page = study.report.read_text("utf-8")
    assert page.count("data:image/svg+xml") == 2 * 3 + 2
    for score in study.sensors:
        assert f"{score.sensor}, virtual field" in page
    assert "http" not in page
    assert study.report.stat().st_size < 6e6


def test_the_numbers_behind_the_page_can_be_read_by_a_program(study):
    scores = json.loads(study.scores.read_text("utf-8"))
    assert scores["provenance"]["Seed"] == "3"
    assert len(scores["provenance"]["Hidden parameters"]) == len("sha256 ") + 64
    mae = {one["sensor"]: one["means"]["multi_mae"] for one in scores["sensors"]}
    assert mae == {score.sensor: score.means.multi_mae for score in study.sensors}


def test_a_second_study_makes_nothing_again_and_says_the_same(study, folder):
    def unheard(stage, done, total):
        assert stage in {"score", "draw"}, f"{stage} was made again"

    page = study.report.read_bytes()
    again = study_chain(chain(folder, progress=unheard), folder)
    assert again.report.read_bytes() == page


def test_a_stop_in_any_stage_loses_no_simulation(study, tmp_path):
    heard = []

    def stopped(stage, done, total):
        heard.append((stage, done))
        if (stage, done) == ("campaign", 32):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        _ = chain(tmp_path, progress=stopped).campaign

    heard.clear()
    record = chain(tmp_path, progress=lambda *told: heard.append(told[:2])).campaign
    assert heard[0] == ("campaign", 32)
    assert len(record) == RECIPE.cases


def test_virtual_sensors_follow_another_record_and_teach_nobody(study, folder):
    stages = chain(folder)
    record = stages.field.buoy
    part = record.between(RECIPE.start, RECIPE.start.replace(day=20))
    shown = stages.driven_by(part)
    assert len(shown.buoy) == len(part)
    assert stages.driven_by(part).sensors.keys() == set(SMALL.sensor_names)
    assert len(list((folder / "stages").glob("twin-*"))) == 1
    assert len(list((folder / "stages").glob("display-*"))) == 1


def test_a_twin_is_scored_alone_on_the_days_after_its_lessons(study, folder, tmp_path):
    stages = chain(folder)
    scores = score_record(stages.twin, stages.field, out=tmp_path, seed=RECIPE.seed)
    assert [score.means for score in scores] == [score.means for score in study.sensors]
    assert len(list(tmp_path.glob("*.svg"))) == 2 * len(scores)
    assert len(json.loads((tmp_path / "scores.json").read_text())["sensors"]) == len(scores)
