"""Intervals of loads in waves of bridles without a shackle, by the windows of those with one."""

import itertools
import json
from dataclasses import fields, replace
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from seacage.ocean import SeaState
from seacage.records import Sample
from seacage.service._live._answers import state_of
from seacage.surrogates import LoadPrediction, Loads
from seacage.twin import Answered, Metocean, Twin
from seacage.twin._correction import WindowErrors, relative_in_waves
from seacage.twin._saving import from_parts, to_parts
from wavy import CAGE, true_loads, wavy_twin

SEAS = tuple(
    SeaState(current_speed=0.1 + 0.03 * n, current_to=25.0 * n, hs=0.5 + 0.1 * n, tp=6.0,
             wave_from=200.0)
    for n in range(12)
)  # fmt: skip
SHACKLES = tuple(one.name for one in CAGE.shackles)
BRIDLES = CAGE.bridle_count
STATISTICS = "std", "maximum_3h", "damage_equivalent"
OFF = 1.5  # standard deviations of the cage over level 1's
LOWER = 0.8  # and its means


@cache
def low() -> Loads:
    loads = wavy_twin().predict(SEAS).line
    assert loads is not None
    return loads


def twin_with(shackles: int) -> Twin:
    """A twin whose first shackles have seen a cage of other loads."""
    mean, std = true_loads(CAGE, SEAS)
    errors = {
        one.name: WindowErrors.of_windows(
            low(), one.bridle, BRIDLES, mean=LOWER * mean[:, one.bridle],
            std=OFF * std[:, one.bridle], share=1 / 18,
        )
        for one in CAGE.shackles[:shackles]
    }  # fmt: skip
    known = {name: one for name, one in errors.items() if one is not None}
    assert len(known) == shackles
    return replace(wavy_twin(), models=replace(wavy_twin().models, line_errors=known))


def parts_of(twin: Twin, seas: tuple[SeaState, ...] = SEAS) -> list[LoadPrediction]:
    loads = twin.predict(seas).line
    assert loads is not None
    return [getattr(loads, name) for name in STATISTICS]


def test_bridles_have_intervals_that_hold_another_cage_s_loads_and_other_lines_none():
    mean, std = true_loads(CAGE, SEAS)
    truth = OFF * std, LOWER * mean + 4.0 * OFF * std, 2.5 * OFF * std
    for load, true in zip(parts_of(twin_with(5)), truth, strict=True):
        lower, upper = load.interval(0.95)
        held = (lower <= true) & (true <= upper)
        assert held[:, :BRIDLES].mean() > 0.9
        assert (lower[:, :BRIDLES] >= 0.0).all()
        assert np.isnan(lower[:, BRIDLES:]).all()
        assert np.isnan(upper[:, BRIDLES:]).all()


def test_the_expected_loads_stay_those_of_level_1():
    for load, name in zip(parts_of(twin_with(5)), STATISTICS, strict=True):
        np.testing.assert_array_equal(load.mean, getattr(low(), name).mean)


@pytest.mark.parametrize("shackles", [0, 1, 2])
def test_of_fewer_than_three_shackles_there_is_no_interval(shackles: int):
    twin = twin_with(shackles)
    assert not twin.predict(SEAS).line_calibrated.any()
    assert np.isnan(twin.predict(SEAS).maximum_interval()).all()
    for load in parts_of(twin):
        assert np.isnan(load.interval(0.95)).all()


def test_the_more_simulations_are_off_at_the_shackles_the_wider_is_the_interval():
    def widths(off: float) -> np.ndarray:
        errors = {name: WindowErrors(std=off, maximum=off) for name in SHACKLES[:3]}
        models = replace(wavy_twin().models, line_errors=errors)
        loads = parts_of(replace(wavy_twin(), models=models))
        ends = np.stack([load.interval(0.95) for load in loads])
        return (ends[:, 1] - ends[:, 0])[..., :BRIDLES]

    for less, more in itertools.pairwise([0.1, 0.5, 2.0]):
        assert (widths(more) > widths(less)).all()


def test_one_shackle_s_errors_count_less_than_what_is_expected_and_five_s():
    few, many = ([WindowErrors(std=9.0, maximum=9.0)] * count for count in (3, 5))
    three, five = relative_in_waves(few), relative_in_waves(many)
    assert three is not None
    assert five is not None
    assert three.std < five.std < 9.0
    assert three.maximum < five.maximum < 9.0
    assert relative_in_waves(few[:2]) is None


def test_an_hour_is_the_least():
    line, some = CAGE.shackles[0].bridle, low().rows(slice(5))
    still = np.ones(5)
    assert WindowErrors.of_windows(some, line, BRIDLES, mean=still, std=still, share=1 / 18) is None


def test_outside_the_domain_and_without_tp_there_is_no_interval():
    beyond = replace(SEAS[3], current_speed=2.0, tp=19.0)
    answer = twin_with(5).predict([SEAS[3], beyond])
    assert answer.line_in_domain.tolist() == [True, False]
    whole = Metocean.of(SEAS[3])
    assumed = twin_with(5).predict(replace(whole, tp=np.full(1, np.nan)))
    assert assumed.line_tp_assumed.all()
    for rows in (answer.maximum_interval()[0][1:], assumed.maximum_interval()[0]):
        assert np.isnan(rows).all()
    assert np.isfinite(answer.maximum_interval()[0][0, :BRIDLES]).all()


def test_all_doors_give_the_same_interval_and_json_no_nan():
    twin, now = twin_with(5), datetime(2020, 1, 18, tzinfo=UTC)
    sea = SEAS[4]
    current = {"current_speed_m_s": sea.current_speed, "current_to_deg": sea.current_to}
    waves = {"hs_m": sea.hs, "tp_s": sea.peak_period, "wave_from_deg": sea.wave_from}
    sample = Sample(stream="buoy-1", t=now, values=current | waves)
    state, events = twin.step(twin.start(), sample, now)
    (answered,) = (one for one in events if isinstance(one, Answered))
    said = state_of("ace", twin, answered, state)
    lower, upper = answered.answer.maximum_interval()
    loads = answered.answer.line
    assert loads is not None
    np.testing.assert_array_equal(loads.maximum_3h.interval(0.95), (lower, upper))
    for k, line in enumerate(said.lines):
        largest = line.maximum_3h_kn
        if k < BRIDLES:
            assert (largest.lower, largest.upper) == (
                pytest.approx(lower[0, k] / 1e3, abs=1e-3),
                pytest.approx(upper[0, k] / 1e3, abs=1e-3),
            )
        else:
            assert largest.lower is largest.upper is None

    def refuse(word: str) -> float:
        raise AssertionError(word)

    json.loads(said.model_dump_json(), parse_constant=refuse)


def test_a_saved_twin_has_the_same_interval_and_an_older_one_none(tmp_path: Path):
    twin = twin_with(3)
    twin.write(tmp_path / "twin")
    again = Twin.read(tmp_path / "twin")
    np.testing.assert_array_equal(
        again.predict(SEAS).maximum_interval(), twin.predict(SEAS).maximum_interval()
    )
    parts = {one.name: getattr(twin, one.name) for one in fields(twin) if one.init}
    settings, arrays = to_parts(**parts)
    del settings["line_errors"]
    assert from_parts(settings, arrays, source="old")["models"].line_errors == {}


def test_lines_and_hours_taken_together_keep_the_interval():
    largest = parts_of(twin_with(5))[1]
    some = np.array([2, 0])
    np.testing.assert_array_equal(
        largest.lines(some).interval(0.95), [end[:, some] for end in largest.interval(0.95)]
    )
    pooled = largest.pooled(1 / 18)
    (lower,), (upper,) = pooled.interval(0.95)
    assert (lower[:BRIDLES] < pooled.mean[0, :BRIDLES]).all()
    assert (pooled.mean[0, :BRIDLES] < upper[:BRIDLES]).all()
    np.testing.assert_array_equal(np.isfinite(largest.std[0]), np.arange(len(lower)) < BRIDLES)
