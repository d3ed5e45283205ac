"""Sea states and a current become a twin, a page and its numbers, through every stage."""

import json
from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
from seacage.conventions import InputError, Origin
from seacage.records import FieldRecord, check_record
from seacage.studies import (
    PaperStudy,
    paper_study,
    score_record,
)
from seacage.studies._chain import Chain, Recipe
from seacage.studies._paper._study import study_chain
from seacage.twin import Twin
from stand_in import StandIn

COARSE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16})
SMALL = replace(COARSE, shackle=COARSE.shackle[:2], depth_sensor=COARSE.depth_sensor[1:2])
RECIPE = Recipe(
    cases=60, held_out_cases=12, days=10.0, teaching_days=5, high_fidelity_points=60, seed=3
)

# All stand on a study that is made whole.
pytestmark = pytest.mark.slow


def chain(folder, **options) -> Chain:
    return Chain(folder=folder / "stages", cage=SMALL, recipe=RECIPE, workers=1, **options)


def refuse_again(stage, done, total):
    assert stage in {"score", "draw", "shape error"}, f"{stage} was made again"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("study")


@pytest.fixture(scope="module", autouse=True)
def stand_in():
    """Settle by a formula: the true simulator's journey is that of the campaign."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.settle", StandIn().settle)
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
    page = " ".join(study.report.read_text("utf-8").split())
    assert page.count("data:image/svg+xml") == 6, "net, loads, depths, errors, nets, by speed"
    assert "Every reading is of the virtual field" in page
    assert "Where the paper is at odds with itself" in page
    for claim in study.claims:
        assert claim.verdict in page
    assert "http" not in page
    assert study.report.stat().st_size < 6e6


def test_the_numbers_behind_the_page_can_be_read_by_a_program(study):
    scores = json.loads(study.scores.read_text("utf-8"))
    assert scores["provenance"]["Seed"] == "3"
    assert len(scores["provenance"]["Hidden parameters"]) == len("sha256 ") + 64
    mae = {one["sensor"]: one["means"]["multi_mae"] for one in scores["sensors"]}
    assert mae == {score.sensor: score.means.multi_mae for score in study.sensors}
    assert scores["origin"] == "virtual field"
    assert {one["model"] for one in scores["shapes"]} >= {"ShapeGP", "PCA-GP, 3 modes"}
    assert [one["claim"] for one in scores["claims"]] == [one.claim for one in study.claims]


def test_a_second_study_makes_nothing_again_and_says_the_same(study, folder):
    page = study.report.read_bytes()
    again = study_chain(chain(folder, progress=refuse_again), folder)
    assert again.report.read_bytes() == page


@pytest.fixture(scope="module")
def in_waves(study, folder):
    """A campaign in waves, and a field whose buoy tells of waves, as from another command."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.simulate", StandIn().simulate)
        run_campaign(SMALL, Plan.sample(3, 60), folder / "campaign.zarr", workers=1)
    made = chain(folder)
    buoy = made.field.buoy
    hs = 1.0 + 0.5 * np.sin(np.arange(len(buoy)) / 90.0)
    waves = {"hs_m": hs, "tp_s": 5.0 * np.sqrt(hs), "wave_from_deg": np.full(len(buoy), 270.0)}
    buoy = check_record(replace(buoy, values={**buoy.values, **waves}, flags={}))
    kept = np.arange(len(buoy)) % 50 != 7  # the radio lost some words; the truth has them all
    received = replace(
        buoy,
        time=buoy.time[kept],
        values={key: column[kept] for key, column in buoy.values.items()},
        flags={key: flags[kept] for key, flags in buoy.flags.items()},
    )
    replace(made.field, buoy=received).write(folder / "field")
    replace(made.truth, buoy=buoy).write(folder / "field" / "truth")
    return folder / "campaign.zarr", folder / "field"


def given(folder, in_waves, **options) -> Chain:
    campaign, field = in_waves
    return Chain(
        folder=folder / "stages",
        cage=SMALL,
        recipe=replace(RECIPE, method="simulate"),
        given_campaign=campaign,
        given_field=field,
        workers=1,
        **options,
    )


def test_a_given_campaign_and_field_are_studied_with_and_without_waves(in_waves, tmp_path):
    study = study_chain(given(tmp_path, in_waves), tmp_path)
    assert study.level_one.cases == 12, "the last of the campaign given judge"
    assert [way.name for way in study.ways] == [
        "Current, spread",
        "Current, minutes in a row",
        "Current and waves, spread",
    ]
    readings = {(one.sensor, one.raw.readings) for way in study.ways for one in way.sensors}
    assert len(readings) == len(SMALL.sensor_names), "all ways are judged on the same readings"
    assert {one.inputs for one in study.shapes} > {"current", "current and waves"}
    page = study.report.read_text("utf-8")
    assert "Training readings and inputs" in page
    assert page.count("data:image/svg+xml") == 7
    again = study_chain(given(tmp_path, in_waves, progress=refuse_again), tmp_path)
    assert again.report.read_text("utf-8") == page


def test_what_was_given_makes_a_twin_of_its_own(in_waves, folder, tmp_path):
    one = given(tmp_path, in_waves)
    other = replace(one, given_field=None)
    assert one._sources != other._sources
    assert one._sources["campaign_sha256"] == one.campaign.sha256
    assert len(one.campaign) == 48
    assert not {sea.current_to for sea in one.campaign.seas} & {
        sea.current_to for sea in one.held_out.seas
    }


def test_a_measured_record_is_refused_for_it_has_no_truth(in_waves, tmp_path):
    campaign, field = in_waves
    measured = replace(FieldRecord.read(field), origin=Origin.MEASURED)
    measured.write(tmp_path / "field")
    with pytest.raises(InputError, match="no truth is known"):
        paper_study(tmp_path, campaign=campaign, field=tmp_path / "field", workers=1)


def test_a_campaign_of_another_cage_is_refused(in_waves, tmp_path):
    with pytest.raises(InputError, match="another cage"):
        _ = replace(given(tmp_path, in_waves), cage=COARSE).campaign


def test_a_stop_in_any_stage_loses_no_simulation(study, tmp_path):
    messages = []

    def stopped(stage, done, total):
        messages.append((stage, done))
        if (stage, done) == ("campaign", 32):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        _ = chain(tmp_path, progress=stopped).campaign

    messages.clear()
    record = chain(tmp_path, progress=lambda *report: messages.append(report[:2])).campaign
    assert messages[0] == ("campaign", 32)
    assert len(record) == RECIPE.cases


def test_a_twin_is_scored_alone_on_the_days_after_its_training_windows(study, folder, tmp_path):
    stages = chain(folder)
    twin = Twin.read(stages.ensure_twin(stages.recipe.training))
    scores = score_record(twin, stages.field, out=tmp_path, seed=RECIPE.seed)
    assert [score.means for score in scores] == [score.means for score in study.sensors]
    assert len(list(tmp_path.glob("*.svg"))) == 2 * len(scores)
    assert len(json.loads((tmp_path / "scores.json").read_text())["sensors"]) == len(scores)
