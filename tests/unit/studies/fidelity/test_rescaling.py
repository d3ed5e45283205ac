"""The best rescaling and rotation, and what it leaves."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from field_windows import answers, make_windows
from seacage.studies._fidelity import _rescaling
from seacage.studies._fidelity._rescaling import (
    Moving,
    _fit_gain_and_offset,
    rescalings,
    teaching_days,
)
from seacage.studies._stages import Stages
from seacage.surrogates import GaussianProcess, current_features


@pytest.fixture(scope="module")
def smooth():
    """The windows' own formula as it is learned from currents."""
    rng = np.random.default_rng(0)
    velocity = rng.uniform(-1.8, 1.8, (150, 2))
    values = answers(velocity, 8)
    return GaussianProcess(restarts=0).fit(current_features(velocity), values)


@pytest.fixture
def learned(smooth, monkeypatch):
    monkeypatch.setattr(_rescaling, "_fit_settled", lambda *_: (smooth, np.zeros(8)))


def found(windows):
    def check_stage(stage, done, total):
        assert stage == "rescaling"

    stages = Stages(folder=Path("unused"), progress=check_stage)
    return rescalings(windows, stages, seed=0)


def changed(windows, *, factor, turn, gain, offset):
    """Windows whose truth is the low fidelity in a faster and turned current."""
    angle = np.deg2rad(turn)
    rotation = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    velocity = factor * windows.water.current_velocity @ np.array(rotation)
    return replace(windows, truth=gain * answers(velocity, 8) + offset)


def test_a_truth_that_is_a_rescaling_leaves_almost_nothing(learned):
    windows = changed(make_windows(), factor=1.2, turn=14.0, gain=0.9, offset=0.3)
    for one in found(windows):
        assert one.left < 0.05, "the formula is learned to within a hundredth"
        assert not one.enough
        assert one.turn == pytest.approx(14.0, abs=4.0), "in steps of 2"


def test_noise_that_no_rescaling_knows_is_left(learned):
    windows = make_windows()
    for one in found(windows):
        assert one.left_mae == pytest.approx(0.08, rel=0.25), "of a normal error of sd 0.1"
        assert one.low_mae > one.left_mae
        assert one.above_least.mean == pytest.approx(one.left_mae - 0.1 * one.low_mae)


def test_what_waves_add_stays(smooth):
    windows = make_windows(days=2)
    shifted = replace(windows, low=windows.low + 7.0)
    calm, wavy = (Moving(windows=some, settled=smooth) for some in (windows, shifted))
    assert wavy.answers_at(1.3, 20.0) - calm.answers_at(1.3, 20.0) == pytest.approx(7.0)
    assert calm.answers_at(1.0, 0.0) == pytest.approx(windows.low)


def test_the_fit_of_least_absolute_error_does_not_hear_outliers():
    answer = np.linspace(0.0, 10.0, 200)
    truth = 2.0 * answer - 1.0
    truth[::10] += 50.0
    gain, offset = _fit_gain_and_offset(answer[None], truth)[0]
    assert (gain, offset) == pytest.approx((2.0, -1.0), abs=1e-2)


def test_every_other_day_teaches_and_a_lone_day_is_halved():
    windows = make_windows(days=4, each=6)
    assert teaching_days(windows).reshape(4, 6).all(axis=1).tolist() == [True, False, True, False]
    assert teaching_days(make_windows(days=1, each=6)).tolist() == [True] * 3 + [False] * 3
