"""Models of the shape on the same simulations."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
from seacage.studies._paper import _shape_models
from seacage.studies._paper._shape_models import (
    PCA_DEGREES,
    PCA_PAPER,
    PCA_WAVES,
    SHAPE,
    SHAPE_CURRENT,
    SHAPE_FOLDED,
    shape_models,
)
from seacage.studies._paper._shape_study import ShapeTrial, shape_study
from seacage.studies._stages import Stages
from stand_in import StandIn

CAGE = Cage.named("ace").altered(mesh={"ring_depths_m": [0.0, 15.0, 23.0], "spokes": 8})


def no_progress(*_):
    pass


def refuse(stage, *_):
    pytest.fail(f"{stage} was made again")


@pytest.fixture(scope="module")
def trial(tmp_path_factory) -> ShapeTrial:
    """A cage that waves push, too, as 30 and 8 half-hours of a formula."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.campaigns._cases.simulate", StandIn().simulate)
        records = [
            run_campaign(
                CAGE,
                Plan.sample(seed, cases, hs=(0.0, 3.0)),
                tmp_path_factory.mktemp("campaign") / "campaign.zarr",
                workers=1,
            )
            for seed, cases in ((0, 30), (1, 8))
        ]
    campaign, held_out = (replace(one, node_position=_pushed(one)) for one in records)
    every = np.concatenate([campaign.node_position, held_out.node_position])
    away = (every - CAGE.design_position).reshape(len(every), -1)
    sway = 0.01 * np.eye(away.shape[1])  # within a half-hour, in no direction more than another
    campaign = replace(campaign, second_moment=away.T @ away / len(every) + sway)
    return ShapeTrial(cage=CAGE, campaign=campaign, held_out=held_out, seed=0)


def _pushed(record):
    push = np.array([2.0 * sea.hs * sea.wave_direction for sea in record.seas])
    moved = record.node_position.copy()
    moved[..., :2] += push[:, None] * (-CAGE.design_position[:, 2:] / 31.0)
    return moved


@pytest.fixture(scope="module")
def study(trial, tmp_path_factory):
    models, left_out = shape_models(CAGE, waves=True, networks=False)
    stages = Stages(folder=tmp_path_factory.mktemp("stages"))
    return shape_study(models, trial, stages, left_out=left_out, progress=no_progress), stages


@pytest.mark.slow
def test_what_hears_the_waves_beats_what_does_not(study):
    scores = study[0].scores
    assert scores[SHAPE].mae < 0.5 * scores[SHAPE_CURRENT].mae
    assert scores[PCA_WAVES].mae < scores[PCA_PAPER].mae
    assert (scores[SHAPE].inputs, scores[SHAPE_CURRENT].inputs) == ("current and waves", "current")
    assert scores[PCA_DEGREES].inputs == "current in degrees"
    assert scores[PCA_DEGREES].mae != scores[PCA_PAPER].mae
    assert scores[PCA_PAPER].modes == 3


@pytest.mark.slow
def test_a_second_study_trains_nothing_again_and_says_the_same(study, trial):
    models, left_out = shape_models(CAGE, waves=True, networks=False)
    again = shape_study(models, trial, study[1], left_out=left_out, progress=refuse)
    assert again.scores[SHAPE].axis_mae == study[0].scores[SHAPE].axis_mae
    assert again.scores[SHAPE].fit_cpu_s == study[0].scores[SHAPE].fit_cpu_s


def test_a_cage_without_the_symmetry_is_reported_and_the_rest_goes_on(trial, tmp_path):
    models, _ = shape_models(CAGE, waves=True, networks=False)
    moved = trial.campaign.node_position.copy()
    moved[:, CAGE.node(2, 0), 2] += 3.0  # one node hangs higher, whatever the current
    uneven = replace(trial, campaign=replace(trial.campaign, node_position=moved))
    few = [model for model in models if model.name in (SHAPE, SHAPE_FOLDED)]
    study = shape_study(few, uneven, Stages(folder=tmp_path), progress=no_progress)
    assert list(study.scores) == [SHAPE]
    assert study.best.model == SHAPE
    assert study.left_out[0].startswith("ShapeGP, folded is missing")


@pytest.mark.slow
def test_the_nets_drawn_are_a_fast_and_a_slow_test_case(study):
    harsh, mild = study[0].cases
    speed = np.sort(study[0].current_speed)
    assert (harsh.called, mild.called) == ("Harsh", "Mild")
    assert harsh.sea.current_speed == pytest.approx(speed[7])
    assert mild.sea.current_speed == pytest.approx(speed[1])
    distance = np.linalg.norm(harsh.predicted[SHAPE] - harsh.computed, axis=1).max()
    assert distance == pytest.approx(study[0].scores[SHAPE].case_worst[harsh.row])


@pytest.mark.slow
def test_the_variance_is_counted_over_cases_and_over_all_time_steps(study):
    shares = study[0].variance
    assert len(shares) == 4
    assert all(0.5 < share <= 1.0 for share in shares.values())
    assert shares["all time steps, centred"] < shares["means of the cases, centred"]
    assert shares["all time steps, not centred"] > shares["all time steps, centred"]


def test_networks_that_cannot_be_had_are_reported(monkeypatch):
    models, (why,) = shape_models(CAGE, waves=False, networks=False)
    assert [model.name for model in models][-2:] == [SHAPE, SHAPE_FOLDED]
    assert "full study" in why
    monkeypatch.setattr(_shape_models, "find_spec", lambda _: None)
    _, (why,) = shape_models(CAGE, waves=False, networks=True)
    assert "JAX is not installed" in why
