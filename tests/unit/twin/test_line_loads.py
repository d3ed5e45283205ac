"""Loads of all lines in waves, from a twin that was trained on a campaign in waves."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage, mooring_lines
from seacage.ocean import SeaState
from seacage.records import Sample
from seacage.service._export import join_answers
from seacage.service._live._answers import state_of
from seacage.twin import Answered, Metocean, Training, Twin, train
from seacage.twin._training._loads import line_symmetry
from wavy import CAGE, true_loads, wavy_campaign, wavy_twin

NOW = datetime(2020, 1, 18, tzinfo=UTC)
SEA = SeaState(current_speed=0.4, current_to=40.0, hs=1.5, tp=7.0, wave_from=200.0)


twin = wavy_twin


def test_every_line_has_its_mean_its_scatter_and_its_expected_maximum():
    answer = twin().predict(SEA)
    lines = mooring_lines(CAGE, anchored=True)
    assert (answer.line_names, answer.line_kinds) == (lines.names, lines.kinds)
    mean, std = true_loads(CAGE, (SEA,))
    assert answer.line is not None
    np.testing.assert_allclose(answer.line.mean.mean, mean, rtol=0.03)
    np.testing.assert_allclose(answer.line.std.mean, std, rtol=0.1)
    np.testing.assert_allclose(answer.line.maximum_3h.mean, mean + 4.0 * std, rtol=0.05)
    assert answer.line_in_domain.all()
    assert answer.line_reason == ("",)


def test_only_the_emulator_has_intervals():
    answer, emulator = twin().predict(SEA), twin().emulator
    assert answer.line is not None
    assert emulator is not None
    assert np.isnan(answer.line.maximum_3h.interval(0.95)).all()
    loads, _, _ = emulator.predict(Metocean.of(SEA))
    lower, upper = loads.maximum_3h.interval(0.95)
    assert (lower < loads.maximum_3h.mean).all()
    assert (loads.maximum_3h.mean < upper).all()


@pytest.mark.parametrize("missing", ["hs", "tp"])
def test_without_waves_there_is_no_number_and_a_reason(missing: str):
    water = replace(Metocean.of([SEA, SEA]), **{missing: np.array([np.nan, getattr(SEA, missing)])})
    answer = twin().predict(water)
    assert answer.line is not None
    assert np.isnan(answer.line.mean.mean[0]).all()
    assert np.isfinite(answer.line.mean.mean[1]).all()
    assert answer.valid.all()
    assert "Tp" in answer.line_reason[0]
    assert answer.line_reason[1] == ""


def test_a_flat_sea_has_no_scatter_and_is_inside_what_was_learned():
    answer = twin().predict(SeaState(current_speed=0.4, current_to=40.0))
    assert answer.line is not None
    assert (answer.line.std.mean == 0.0).all()
    np.testing.assert_array_equal(answer.line.maximum_3h.mean, answer.line.mean.mean)
    assert answer.line_in_domain.all()


@pytest.mark.parametrize(
    "sea", [{"hs": 4.5, "tp": 11.0}, {"hs": 0.3, "tp": 14.0}, {"current_speed": 1.6}]
)
def test_a_sea_beyond_the_training_is_told(sea: dict[str, float]):
    answer = twin().predict(replace(SEA, **sea))
    assert not answer.line_in_domain.any()
    assert answer.line_reason[0].startswith("Outside the currents and waves")


def test_a_campaign_whose_periods_follow_their_heights_teaches_no_loads():
    campaign = wavy_campaign(plan="paper")
    assert train(CAGE, campaign, training=Training(restarts=0)).emulator is None


def test_waves_that_move_nothing_teach_nothing():
    campaign = wavy_campaign()
    low = replace(campaign.seas[0], hs=1e-4, tp=0.5)
    flat = replace(campaign, seas=(low, *campaign.seas[1:]))
    emulator = train(CAGE, flat, training=Training(restarts=0)).emulator
    assert emulator is not None
    assert emulator.domain.lower[1] >= 0.05


def test_loads_are_saved_with_their_twin(tmp_path: Path):
    twin().write(tmp_path / "twin")
    one, other = twin().predict(SEA).line, Twin.read(tmp_path / "twin").predict(SEA).line
    assert one is not None
    assert other is not None
    for name in ("mean", "std", "maximum_3h"):
        np.testing.assert_allclose(getattr(one, name).mean, getattr(other, name).mean, rtol=1e-9)


def buoy(t: datetime, **values: float) -> Sample:
    return Sample(stream="buoy-1", t=t, values=values)


def test_the_state_of_a_cage_has_its_lines():
    state = twin().start()
    values = {"current_speed_m_s": 0.4, "current_to_deg": 40.0}
    waves = {"hs_m": 1.5, "tp_s": 7.0, "wave_from_deg": 200.0}
    state, events = twin().step(state, buoy(NOW, **values, **waves), NOW)
    (answered,) = (one for one in events if isinstance(one, Answered))
    told = state_of("ace", twin(), answered, state)
    assert told.lines_reason == ""
    anchor = next(one for one in told.lines if one.name == "anchor-3")
    assert (anchor.kind, anchor.level, anchor.utilisation) == ("anchor line", 1, None)
    assert anchor.maximum_3h_kn.mean is not None
    assert anchor.mean_kn is not None
    assert anchor.maximum_3h_kn.mean > anchor.mean_kn
    assert anchor.maximum_3h_kn.upper is None
    bridle = told.lines[0]
    capacity = CAGE.bridle_capacity[0] / 1e3
    assert bridle.maximum_3h_kn.mean is not None
    assert bridle.utilisation == pytest.approx(bridle.maximum_3h_kn.mean / capacity, abs=1e-4)

    later = NOW + timedelta(hours=4)  # the waves are old, the current is new
    state, events = twin().step(state, buoy(later, **values), later)
    (answered,) = (one for one in events if isinstance(one, Answered))
    told = state_of("ace", twin(), answered, state)
    assert told.valid
    assert told.lines[0].mean_kn is None
    assert "not all known" in told.lines_reason


SQUARE = Cage.named("ace").altered(mesh={"spokes": 16})
"""Whose bridles are on spokes."""


def test_a_square_cage_has_eight_images_in_any_heading():
    lines = mooring_lines(SQUARE, anchored=True).names
    for names in (lines, lines[:24], SQUARE.bridle_names):  # all, without buoy lines, on springs
        symmetry = line_symmetry(replace(SQUARE, heading=17.0), names)
        assert symmetry is not None
        assert symmetry.source.shape == (8, len(names))
    assert line_symmetry(SQUARE, ("line-1",)) is None


@pytest.mark.slow
def test_a_cage_with_one_long_bridle_has_no_images():
    offset = (0.5, *(0.0,) * 11)
    uneven = replace(SQUARE, bridles=replace(SQUARE.bridles, length_offset=offset))
    assert line_symmetry(uneven, uneven.bridle_names) is None


def test_answers_of_several_blocks_join_with_their_lines():
    seas = [replace(SEA, current_speed=speed) for speed in (0.1, 0.3, 0.5)]
    whole = twin().predict(seas)
    joined = join_answers([twin().predict(seas[:2]), twin().predict(seas[2:])])
    assert whole.line is not None
    assert joined.line is not None
    assert (joined.line_names, joined.line_reason) == (whole.line_names, whole.line_reason)
    one, other = joined.line.maximum_3h.mean, whole.line.maximum_3h.mean
    np.testing.assert_allclose(one, other, rtol=1e-9)
