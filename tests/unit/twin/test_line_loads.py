"""Loads of all lines in waves, from a twin that was trained on a campaign in waves."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage, mooring_lines
from seacage.conventions import Origin
from seacage.ocean import SeaState
from seacage.records import FieldRecord, Record, Sample
from seacage.service._live._answers import state_of
from seacage.twin import Answer, Answered, Metocean, Training, Twin, representative_lines, train
from seacage.twin._alarms._alarm import AlarmInput
from seacage.twin._alarms._conditions import alarm_inputs
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


def water_without(*missing: str) -> Metocean:
    """``SEA`` twice, some of it not known the first time."""
    whole = Metocean.of([SEA, SEA])
    unknown = {name: getattr(whole, name).copy() for name in missing}
    for values in unknown.values():
        values[0] = np.nan
    return replace(whole, **unknown)


@pytest.mark.parametrize("missing", [("hs",), ("wave_direction",), ("hs", "tp")])
def test_without_waves_the_means_are_over_those_of_the_site(missing: tuple[str, ...]):
    answer = twin().predict(water_without(*missing))
    assert answer.line is not None
    assert answer.valid.all()
    for name in ("std", "maximum_3h", "damage_equivalent"):
        assert np.isnan(getattr(answer.line, name).mean[0]).all()
        assert np.isfinite(getattr(answer.line, name).mean[1, :24]).all()
    assert answer.line.damage_per_year is not None
    assert np.isnan(answer.line.damage_per_year[0]).all()
    # the means of ``true_loads`` do not depend on the waves
    np.testing.assert_allclose(answer.line.mean.mean[0], answer.line.mean.mean[1], rtol=0.05)
    assert (answer.line.mean.std[0] > 0.0).all()
    assert "means alone are, over the waves of the training campaign" in answer.line_reason[0]
    assert answer.line_reason[1] == ""
    assert not answer.line_tp_assumed.any()


def test_a_period_that_is_not_known_is_taken_from_the_site_at_the_same_height():
    answer, known = twin().predict(water_without("tp")), twin().predict(SEA)
    assert answer.line is not None
    assert known.line is not None
    assert answer.line_tp_assumed.tolist() == [True, False]
    assert answer.line_reason[0].startswith("Tp is not known; it is taken to be distributed as")
    assert twin().emulator is not None
    assert twin().emulator.waves is not None
    hs, _, _, tp = twin().emulator.waves.table.T
    near = np.argsort(np.abs(hs - SEA.hs))[:32]
    periods = np.sqrt(SEA.hs) * tp[near] / np.sqrt(hs[near])
    several = twin().predict([replace(SEA, tp=float(one)) for one in periods])
    assert several.line is not None
    mean = several.line.std.mean.mean(axis=0)
    np.testing.assert_allclose(answer.line.std.mean[0], mean, rtol=0.01)
    np.testing.assert_allclose(answer.line.std.mean[1], known.line.std.mean[0])
    assert answer.line.damage_per_year is not None
    assert np.isnan(answer.line.damage_per_year[0]).all()


def test_what_is_not_known_widens_the_emulator_s_intervals():
    emulator = twin().emulator
    assert emulator is not None
    for missing in ("hs", "tp"):
        loads, _, _ = emulator.predict(water_without(missing))
        part = loads.mean if missing == "hs" else loads.std
        assert (part.std[0] > part.std[1]).all()
    far, inside, _ = emulator.predict(Metocean.of(replace(SEA, hs=5.0, tp=11.0)))
    assert not inside.any()
    (near, _, _) = emulator.predict(Metocean.of(replace(SEA, hs=2.9, tp=8.4)))
    assert (far.std.log_std > near.std.log_std).all()


def test_a_year_of_a_sea_wears_by_the_curve_of_the_line():
    answer, lines = twin().predict(SEA), mooring_lines(CAGE, anchored=True)
    assert answer.line is not None
    assert answer.line.damage_per_year is not None
    rate = lines.damage_rate(answer.line.damage_equivalent.mean)
    np.testing.assert_allclose(answer.line.damage_per_year, 31_557_600.0 * rate)
    assert (answer.line.damage_per_year[0, :24] > 0.0).all()
    assert np.isnan(answer.line.damage_per_year[0, 24:]).all()  # buoy lines
    beyond = twin().predict(replace(SEA, hs=4.5, tp=11.0)).line
    assert beyond is not None
    assert beyond.damage_per_year is not None
    assert np.isnan(beyond.damage_per_year).all()
    assert np.isfinite(beyond.maximum_3h.mean).all()


def test_the_waves_of_a_site_are_those_of_its_record():
    campaign = wavy_campaign()
    count, hs = 40, np.linspace(0.2, 2.0, 40)
    values = {"current_speed_m_s": 0.0 * hs + 0.3, "current_to_deg": 9.0 * np.arange(count)}
    values |= {"hs_m": hs, "tp_s": 0.0 * hs + 6.0, "wave_from_deg": 0.0 * hs + 270.0}
    record = Record(
        stream="buoy-1",
        time=np.datetime64("2020-01-18T00:00:00", "us") + np.arange(count) * np.timedelta64(1, "h"),
        values=values,
        flags={key: np.ones(count, dtype=np.uint8) for key in values},
        origin=Origin.MEASURED,
    )
    field = FieldRecord(cage="ace", buoy=record, sensors={}, origin=Origin.MEASURED)
    emulator = train(CAGE, campaign, field, training=Training(restarts=0)).emulator
    assert emulator is not None
    assert emulator.waves is not None
    assert emulator.waves.origin == "the waves in the record of buoy-1"
    np.testing.assert_allclose(emulator.waves.table[:, 3], 6.0)


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
    assert (anchor.kind, anchor.level) == ("anchor line", 1)
    assert anchor.maximum_3h_kn.mean is not None
    assert anchor.utilisation == pytest.approx(anchor.maximum_3h_kn.mean / 209.0, abs=1e-4)
    assert anchor.damage_per_year is not None
    assert anchor.mean_spread_kn is None
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
    assert told.water is not None
    assert told.water.tp_s is None
    first = told.lines[0]
    assert first.mean_kn is not None
    assert first.mean_spread_kn is not None
    assert (first.std_kn, first.maximum_3h_kn.mean, first.damage_per_year) == (None, None, None)
    assert "not known" in told.lines_reason


SQUARE = Cage.named("ace").altered(mesh={"spokes": 16})
"""Whose bridles are on spokes."""


def test_a_square_cage_has_eight_images_in_any_heading():
    lines = mooring_lines(SQUARE, anchored=True).names
    for names in (lines, lines[:24], SQUARE.bridle_names):  # all, without buoy lines, on springs
        symmetry = line_symmetry(replace(SQUARE, heading=17.0), names)
        assert symmetry is not None
        assert symmetry.source.shape == (8, len(names))
    assert line_symmetry(SQUARE, ("line-1",)) is None


def test_a_square_cage_has_four_kinds_of_lines_that_hold_it():
    kinds = ("bridle-1", "bridle-2", "frame-1", "anchor-1")
    assert representative_lines(replace(SQUARE, heading=17.0)) == kinds
    assert representative_lines(SQUARE, mooring="springs") == kinds[:2]


@pytest.mark.slow
def test_a_cage_with_one_long_bridle_has_no_images():
    offset = (0.5, *(0.0,) * 11)
    uneven = replace(SQUARE, bridles=replace(SQUARE.bridles, length_offset=offset))
    assert line_symmetry(uneven, uneven.bridle_names) is None
    assert representative_lines(uneven, mooring="springs") == uneven.bridle_names


def test_answers_of_several_blocks_join_with_their_lines():
    seas = [replace(SEA, current_speed=speed) for speed in (0.1, 0.3, 0.5)]
    whole = twin().predict(seas)
    joined = Answer.join(twin().predict(seas[:2]), twin().predict(seas[2:]))
    assert whole.line is not None
    assert joined.line is not None
    assert (joined.line_names, joined.line_reason) == (whole.line_names, whole.line_reason)
    one, other = joined.line.maximum_3h.mean, whole.line.maximum_3h.mean
    np.testing.assert_allclose(one, other, rtol=1e-9)


def loads_raised(water: dict[str, float], *readings: float) -> dict[str, AlarmInput]:
    """The inputs of the lines' alarms in some water, and with readings of bridle 7's shackle."""
    values = {"current_speed_m_s": 0.4, "current_to_deg": 40.0} | water
    shackles = [
        Sample(stream="shackle-1", t=NOW - timedelta(seconds=k), values={"tension_kn": one})
        for k, one in enumerate(readings)
    ]
    state, _ = twin().receive(twin().start(), [buoy(NOW, **values), *shackles], NOW)
    state, events = twin().step(state, None, NOW)
    (answered,) = (one for one in events if isinstance(one, Answered))
    found = alarm_inputs(twin(), state, answered, distrusted=frozenset())
    return {one.alarm: one for one in found if one.alarm.startswith("load.")}


def test_a_cage_without_any_reading_has_an_answer_without_rows():
    answer = twin().models.answer(Metocean.from_table(np.zeros((0, 6))), [])
    assert answer.valid.shape == (0,)
    assert answer.line is not None
    assert answer.line.mean.mean.shape == (0, 28)


def test_an_alarm_compares_the_largest_load_that_is_expected():
    waves = {"hs_m": 1.5, "tp_s": 7.0, "wave_from_deg": 200.0}
    raised, line = loads_raised(waves), twin().predict(SEA).line
    assert line is not None
    lines = mooring_lines(CAGE, anchored=True)
    expected = line.maximum_3h.mean[0] / lines.capacity
    assert len(raised) == 24
    for k, name in enumerate(lines.names[:24]):
        assert raised[f"load.{name}"].value == pytest.approx(expected[k])
        assert "expected in three hours" in raised[f"load.{name}"].detail


def test_without_waves_an_alarm_compares_the_mean_and_says_so():
    raised, answer = loads_raised({}), twin().predict(water_without("hs"))
    assert len(raised) == 12
    mean = answer.bridle_tension.mean[0, 0] / CAGE.bridle_capacity[0]
    assert raised["load.bridle-1"].value == pytest.approx(mean)
    assert raised["load.bridle-1"].detail.startswith("By the mean load")


def test_a_shackle_s_own_largest_reading_counts_in_waves():
    waves = {"hs_m": 1.5, "tp_s": 7.0, "wave_from_deg": 200.0}
    rising = (150.0, 149.0, 148.0)
    assert loads_raised(waves, *rising)["load.bridle-7"].value == pytest.approx(150.0 / 160.0)
    assert loads_raised({}, *rising)["load.bridle-7"].value == pytest.approx(149.0 / 160.0)
