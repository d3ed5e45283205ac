"""Sea states and a current become a twin, a page and its numbers, through every stage."""

import json
from dataclasses import replace

import pytest

from seacage.cage import Cage
from seacage.studies import PaperStudy, _demonstration, prepare_demonstration, score_record
from seacage.studies._chain import Chain, Recipe
from seacage.studies._paper import study_chain
from seacage.twin import Twin
from stand_in import StandIn

COARSE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
SMALL = replace(COARSE, shackle=COARSE.shackle[:2], depth_sensor=COARSE.depth_sensor[1:2])
RECIPE = Recipe(
    cases=60, held_out_cases=12, days=10.0, teaching_days=5, high_fidelity_points=60, seed=3
)


def chain(folder, **options) -> Chain:
    return Chain(folder=folder / "stages", cage=SMALL, recipe=RECIPE, workers=1, **options)


def unheard(stage, done, total):
    assert stage in {"score", "draw"}, f"{stage} was made again"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("study")


@pytest.fixture(scope="module", autouse=True)
def stand_in():
    """Settle by a formula, and make the demonstration of what the study is made of.

    The true simulator's journey is that of the campaign.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.settle", StandIn().settle)
        patch.setattr(_demonstration, "Recipe", lambda: RECIPE)
        patch.setattr(Cage, "named", lambda _: SMALL)
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


def test_a_twin_is_scored_alone_on_the_days_after_its_lessons(study, folder, tmp_path):
    stages = chain(folder)
    scores = score_record(stages.twin, stages.field, out=tmp_path, seed=RECIPE.seed)
    assert [score.means for score in scores] == [score.means for score in study.sensors]
    assert len(list(tmp_path.glob("*.svg"))) == 2 * len(scores)
    assert len(json.loads((tmp_path / "scores.json").read_text())["sensors"]) == len(scores)


def test_a_demonstration_is_a_twin_a_buoy_and_virtual_sensors(study, folder):
    made = prepare_demonstration(folder / "stages", workers=1, progress=unheard)
    twin = Twin.read(made.twin_folder)
    assert twin.sensor_names == made.cage.sensor_names == tuple(made.field.sensors)
    assert made.buoy is made.field.buoy
    assert {made.buoy.origin, made.field.origin, twin.origin} == {"virtual field"}


def test_another_buoys_record_drives_the_show_and_teaches_nobody(study, folder):
    made = prepare_demonstration(folder / "stages", workers=1)
    part = made.buoy.between(RECIPE.start, RECIPE.start.replace(day=20))
    shown = prepare_demonstration(folder / "stages", record=part, workers=1)
    assert shown.twin_folder == made.twin_folder
    assert len(shown.buoy) == len(part)
    assert shown.field.hidden_sha256 == made.field.hidden_sha256
    prepare_demonstration(folder / "stages", record=part, workers=1, progress=unheard)
