"""Loads in waves on held-out days: scores of both fidelities, and of simple baselines."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from seacage.conventions import InputError, Origin
from seacage.figures import svg_text
from seacage.ocean import SeaState
from seacage.records import FieldRecord
from seacage.studies._chain import Chain, Recipe
from seacage.studies._interval import Interval
from seacage.studies._page import render
from seacage.studies._paper import _wave_loads
from seacage.studies._paper._report import draw_wave_loads
from seacage.studies._paper._wave_loads import (
    BASELINES,
    LEVEL_1,
    LEVEL_2,
    METHODS,
    STATISTICS,
    WaveLoads,
    WaveLoadScore,
    predict_statistic,
    score_wave_loads,
    wave_loads,
)
from seacage.twin import Training, train
from wavy import CAGE, wavy_campaign, wavy_field, wavy_twin

SEA = SeaState(current_speed=0.4, current_to=40.0, hs=1.5, tp=6.0, wave_from=220.0)
CASES = 40
CUT = datetime(2020, 1, 18, 9, tzinfo=UTC)


def halves(field: FieldRecord) -> tuple[FieldRecord, FieldRecord]:
    day = timedelta(days=9)
    before, after = (
        {name: one.between(*ends) for name, one in field.sensors.items()}
        for ends in ((CUT - day, CUT), (CUT, CUT + day))
    )
    return replace(field, sensors=before), replace(field, sensors=after)


@cache
def scores(factor: float, *, every: float = 1.0) -> dict[str, WaveLoadScore]:
    teaching, held_out = halves(wavy_field(factor, hours=14.0, every=every))
    settings = Training(high_fidelity_points=25, restarts=0)
    twin = train(CAGE, None, teaching, base=wavy_twin(), training=settings)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("seacage.studies._paper._boosted_trees.ROUNDS", 20)  # in a fifth of the time
        found = score_wave_loads(twin, teaching, held_out, seed=0)
    return {one.statistic: one for one in found}


def test_all_four_statistics_of_a_fast_shackle_are_scored_on_the_days_after_the_cut():
    found = scores(1.4)
    assert list(found) == list(STATISTICS.values())
    for one in found.values():
        assert (one.sensor, one.training_windows, one.windows) == ("shackle-2", 54, 30)
        assert set(one.error) == set(METHODS)
        assert set(one.gain) == set(METHODS) - {LEVEL_2}
        assert one.origin == "virtual field"


def test_level_2_halves_the_error_of_a_line_that_scatters_by_a_factor_more():
    one, wear = (scores(1.4)[name] for name in ("standard deviation", "damage-equivalent load"))
    # 1 - 1 / 1.4, and what a window of a hundred waves scatters by
    assert one.error[LEVEL_1] == pytest.approx(0.29, abs=0.04)
    assert one.error[LEVEL_2] < 0.5 * one.error[LEVEL_1]
    assert wear.error[LEVEL_2] < wear.error[LEVEL_1]
    for some in (one, wear):
        assert some.corrected
        assert some.gain[LEVEL_1].low > 0.0


def test_the_largest_value_is_of_ten_minutes_and_not_of_three_hours():
    loads = wavy_twin().predict(SEA).line
    assert loads is not None
    found, _, _ = predict_statistic(loads, "maximum", 3)
    three_hours = loads.maximum_3h.lines(np.array([3]))
    expected = three_hours.pooled(600.0 / 10800.0).mean[0]
    # The one by halving a bracket, the other in closed form.
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    assert found[0] < three_hours.mean[0, 0]


def test_where_level_1_is_right_level_2_does_not_differ_from_it():
    one = scores(1.0)["standard deviation"]
    assert not one.corrected
    assert one.error[LEVEL_1] == one.error[LEVEL_2]
    assert one.gain[LEVEL_1] == Interval(mean=0.0, low=0.0, high=0.0)


def test_simple_baselines_are_what_their_names_say():
    error = scores(1.4)["standard deviation"].error
    # A factor is a line through level 1, whose waves rise from the first day to the second.
    assert error["gain and offset"] < 0.1
    assert error["sensor alone"] > 0.2
    assert error["boosted trees"] > error["gain and offset"], "trees know no higher waves"


def test_a_slow_shackle_has_no_peaks_and_no_wear():
    found = scores(1.4, every=2.0)
    assert list(found) == ["mean", "standard deviation"]
    assert found["mean"].peak_samples == pytest.approx(3.0)


def test_a_shackle_without_hours_on_both_sides_is_not_scored():
    teaching, held_out = halves(wavy_field(1.4, hours=10.0))
    assert score_wave_loads(wavy_twin(), teaching, held_out, seed=0) == ()


def refuse_training(stage: str, done: int, total: int) -> None:
    assert not stage.startswith("train"), "the twin was trained again"


@pytest.fixture
def chain(tmp_path, monkeypatch) -> Chain:
    """Of a field in waves, and of a campaign that lies nowhere."""
    monkeypatch.setattr(_wave_loads, "read_campaign", lambda _: wavy_campaign(CASES))
    field = wavy_field(1.4, hours=30.0, every=4.0)
    field.write(tmp_path / "field")
    recipe = Recipe(teaching_days=1, high_fidelity_points=25)
    return Chain(
        folder=tmp_path / "stages", cage=CAGE, recipe=recipe, given_field=tmp_path / "field"
    )


@pytest.mark.slow
def test_the_studys_own_field_in_waves_is_taken_and_its_twin_is_trained_once(chain):
    first = wave_loads(chain, cases=0, given=Path("somewhere"))
    assert (first.own_field, first.cases) == (True, CASES)
    assert first.sensors == tuple(one.name for one in CAGE.shackles)
    assert {(one.sensor, one.windows) for one in first.scores} == {("shackle-2", 36)}
    again = wave_loads(replace(chain, progress=refuse_training), cases=0, given=Path("somewhere"))
    assert again == first


@pytest.mark.slow
def test_a_campaign_that_teaches_no_loads_in_waves_is_refused(chain, monkeypatch):
    current = wavy_campaign(CASES, plan="paper")
    monkeypatch.setattr(_wave_loads, "read_campaign", lambda _: current)
    with pytest.raises(InputError, match="plan loads"):
        wave_loads(chain, cases=0, given=Path("somewhere"))


def test_a_campaign_of_another_cage_is_refused(chain):
    other = CAGE.altered(mesh={"spokes": 16})
    with pytest.raises(InputError, match="another cage than"):
        wave_loads(replace(chain, cage=other), cases=0, given=Path("somewhere"))


def test_another_cage_than_the_kept_fields_is_left_out(chain):
    buoy = chain.field.buoy
    current = {key: one for key, one in buoy.values.items() if key.startswith("current")}
    replace(chain.field, buoy=replace(buoy, values=current, flags={})).write(chain.given_field)
    still = replace(chain)
    assert wave_loads(still, cases=0) == WaveLoads(own_field=False)


EXAMPLE = WaveLoadScore(
    sensor="shackle-1",
    statistic="mean",
    origin=Origin.VIRTUAL_FIELD,
    every_s=2.0,
    peak_samples=2.5,
    training_windows=70,
    windows=140,
    corrected=True,
    error={LEVEL_2: 0.1, LEVEL_1: 0.4, **dict.fromkeys(BASELINES, 0.2)},
    gain=dict.fromkeys(METHODS[1:], Interval(mean=0.2, low=0.1, high=0.3)),
    coverage=0.94,
)


def page(*some: WaveLoadScore, **values: Any) -> str:
    """The section's text, on one line."""
    own = {"cases": 100, "sensors": tuple(one.sensor for one in some), **values}
    html = render(
        "wave_loads.html",
        wave_loads=WaveLoads(own_field=False, scores=some, **own),
        cage=CAGE,
        methods=METHODS,
        baselines=BASELINES,
        statistics=tuple(STATISTICS.values()),
        pictures={"loads": None},
    )
    return " ".join(html.split())


def test_a_proven_gain_everywhere_is_better():
    text = page(EXAMPLE)
    assert '<dt class="better">better</dt> <dd><strong>Mean.</strong>' in text
    assert "proven better than every baseline at every shackle" in text
    assert "No baseline has a smaller error anywhere" in text
    assert text.count("not evaluated") == 3
    assert "virtual field" in text


def test_a_baseline_that_is_nearer_is_named():
    ahead = {**EXAMPLE.error, "linear": 0.05}
    unsure = {**EXAMPLE.gain, "linear": Interval(mean=-0.1, low=-0.3, high=0.1)}
    text = page(replace(EXAMPLE, error=ahead, gain=unsure))
    assert '<dt class="unproven">behind</dt>' in text
    assert "larger error than a baseline at shackle-1 (linear): none of these is proven" in text
    sure = {**EXAMPLE.gain, "linear": Interval(mean=-0.1, low=-0.3, high=-0.05)}
    text = page(replace(EXAMPLE, error=ahead, gain=sure))
    assert '<dt class="worse">worse</dt>' in text
    assert "proven worse at shackle-1 (linear)" in text


def test_a_level_2_that_is_level_1_or_worse_is_no_success():
    zero = {**EXAMPLE.gain, LEVEL_1: Interval(mean=0.0, low=0.0, high=0.0)}
    text = page(replace(EXAMPLE, corrected=False, gain=zero))
    assert '<dt class="unproven">no gain</dt>' in text
    assert "showed no gain at every shackle, where it is level 1" in text
    lost = {**EXAMPLE.gain, LEVEL_1: Interval(mean=-0.2, low=-0.3, high=-0.1)}
    text = page(EXAMPLE, replace(EXAMPLE, sensor="shackle-2", gain=lost))
    assert '<dt class="worse">worse in part</dt>' in text
    assert "better than level 1 at shackle-1, proven worse at shackle-2" in text


def test_what_was_left_out_is_named():
    text = page(EXAMPLE, sensors=("shackle-1", "shackle-2"))
    assert "At shackle-1 a reading came every 2 s, 2.5 to a peak period" in text
    assert "shackle-2 has no two hours of whole windows" in text
    assert "of another cage" in page(cases=0)


def test_the_figure_has_a_panel_for_each_statistic_with_scores():
    some = tuple(scores(1.4, every=2.0).values())
    loads = WaveLoads(own_field=True, scores=some)
    assert svg_text(draw_wave_loads(loads)) == svg_text(draw_wave_loads(loads))
    assert np.isfinite([list(one.error.values()) for one in some]).all()
