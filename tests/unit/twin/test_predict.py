from dataclasses import replace

import numpy as np
import pytest

from predicted_nets import level_1_twin
from seacage.conventions import Flag, InputError
from seacage.ocean import SeaState
from seacage.testing import stand_in_campaign, stand_in_field, stand_in_seas, stand_in_twin
from seacage.twin import Answered, Metocean, replay


def numbers(answer):
    """Every number of an answer, by row."""
    parts = (
        answer.bridle_low,
        answer.node_position,
        answer.node_sigma,
        answer.node_std,
        answer.volume_fraction,
        answer.volume_std,
        *(
            getattr(prediction, part)
            for prediction in (answer.bridle_tension, answer.sensor, answer.sensor_low)
            for part in ("mean", "std")
        ),
    )
    return np.hstack([part.reshape(len(answer), -1) for part in parts])


def test_a_valid_row_has_every_number_and_an_invalid_one_has_none():
    water = Metocean.of(stand_in_seas(4))
    velocity = water.current_velocity.copy()
    velocity[2] = np.nan
    answer = stand_in_twin().predict(replace(water, current_velocity=velocity))
    assert answer.valid.tolist() == [True, True, False, True]
    assert np.isfinite(numbers(answer)[answer.valid]).all()
    assert np.isnan(numbers(answer)[2]).all()
    assert answer.reason[2] == "A number of the input is not known."
    assert not answer.in_domain[2]


def test_one_sea_state_is_one_row():
    answer = stand_in_twin().predict(SeaState(current_speed=0.5, current_to=90.0))
    assert len(answer) == 1
    assert answer.node_position.shape == (1, 81, 3)
    assert answer.reason == ("",)


def test_rows_answer_alone_as_they_answer_together():
    seas = stand_in_seas(7, seed=4, current_speed=1.3)
    together = numbers(stand_in_twin().predict(seas))
    alone = np.vstack([numbers(stand_in_twin().predict(sea)) for sea in seas])
    # Matrix products of other sizes round differently.
    np.testing.assert_allclose(together, alone, rtol=1e-6, atol=1e-6)


def test_more_rows_than_a_block_answer_as_few_do():
    seas = stand_in_seas(520, seed=4)
    many, few = stand_in_twin().predict(seas), stand_in_twin().predict(seas[-3:])
    np.testing.assert_allclose(many.sensor.mean[-3:], few.sensor.mean, rtol=1e-6)
    np.testing.assert_allclose(many.node_sigma[-3:], few.node_sigma, rtol=1e-6, atol=1e-9)


def test_no_rows_are_answered_with_no_rows():
    answer = stand_in_twin().predict([])
    assert len(answer) == 0
    assert answer.node_position.shape == (0, 81, 3)


def test_every_answer_says_its_level():
    twin = stand_in_twin()
    answer = twin.predict(SeaState(current_speed=0.5, current_to=90.0))
    corrected = {one.bridle for one in twin.cage.shackles}
    assert answer.sensor_level.tolist() == [2] * 8
    assert answer.bridle_level.tolist() == [2 if line in corrected else 1 for line in range(12)]
    assert answer.shape_level == 2
    assert answer.sensor_units == ("m", "m", "m", "N", "N", "N", "N", "N")


def test_an_uninstrumented_bridle_answers_what_the_simulations_say():
    answer = stand_in_twin().predict(stand_in_seas(5))
    plain = answer.bridle_level == 1
    np.testing.assert_array_equal(answer.bridle_tension.mean[:, plain], answer.bridle_low[:, plain])


def test_level_one_repeats_the_simulations():
    cage, seas = stand_in_twin().cage, stand_in_seas(60, seed=8)
    truth, answer = stand_in_campaign(cage, seas), level_1_twin().predict(seas)
    assert answer.shape_level == 1
    assert np.abs(answer.node_position - truth.node_position).max() < 0.15
    spread = truth.bridle_tension.std()
    assert np.abs(answer.bridle_low - truth.bridle_tension).max() < 0.1 * spread


def test_a_sensor_answers_the_same_whichever_others_have_level_2():
    twin, seas = stand_in_twin(), stand_in_seas(9, seed=3, current_speed=1.3)
    whole, bridles = twin.predict(seas), {one.name: one.bridle for one in twin.cage.shackles}
    for names in (["depth-2"], ["shackle-4", "depth-3", "shackle-1"]):
        upper = {name: twin.models.upper[name] for name in names}
        part = replace(twin, models=replace(twin.models, upper=upper)).predict(seas)
        columns = [twin.sensor_names.index(name) for name in names]
        ropes = [bridles[name] for name in names if name in bridles]
        assert np.flatnonzero(part.sensor_level == 2).tolist() == sorted(columns)
        assert np.flatnonzero(part.bridle_level == 2).tolist() == sorted(ropes)
        for one, other, at in (
            (part.sensor, whole.sensor, columns),
            (part.bridle_tension, whole.bridle_tension, ropes),
        ):
            np.testing.assert_allclose(one.mean[:, at], other.mean[:, at], rtol=1e-9)
            np.testing.assert_allclose(one.std[:, at], other.std[:, at], rtol=1e-9)


def test_a_reading_is_less_sure_than_the_rope_it_reads():
    twin = stand_in_twin()
    answer = twin.predict(stand_in_seas(5))
    lines = [one.bridle for one in twin.cage.shackles]
    pulling = np.maximum(answer.sensor.mean[:, 3:], 0.0)
    np.testing.assert_allclose(pulling, answer.bridle_tension.mean[:, lines])
    assert (answer.sensor.std[:, 3:] > answer.bridle_tension.std[:, lines]).all()


def test_a_depth_sensors_level_one_is_its_node_of_the_shape():
    twin = stand_in_twin()
    answer = level_1_twin().predict(stand_in_seas(5))
    nodes = [one.node for one in twin.cage.depth_sensors]
    np.testing.assert_allclose(
        answer.sensor_low.mean[:, :3], -answer.node_position[:, nodes, 2], atol=1e-9
    )
    assert (answer.node_sigma[:, nodes] >= answer.sensor_low.std[:, :3] - 1e-9).all()


def test_still_water_leaves_the_whole_volume():
    answer = stand_in_twin().predict(SeaState(current_speed=0.0, current_to=0.0))
    assert answer.volume_fraction == pytest.approx([1.0])


def test_a_rope_never_pushes():
    answer = stand_in_twin().predict(stand_in_seas(40, seed=2, current_speed=2.0))
    assert answer.bridle_tension.mean.min() >= 0.0
    assert answer.bridle_low.min() >= 0.0


def test_no_interval_reaches_below_a_slack_rope_or_above_the_surface():
    answer = stand_in_twin().predict(stand_in_seas(40, seed=2, current_speed=2.0))
    for lower, upper in (answer.bridle_interval(), answer.sensor_interval()):
        assert np.nanmin(lower) == 0.0
        assert (upper >= lower)[np.isfinite(lower)].all()


def test_a_sensor_that_trained_nothing_has_no_interval():
    twin = stand_in_twin()
    bare = replace(twin, models=replace(twin.models, upper={}))
    lower, upper = bare.predict(stand_in_seas(5)).sensor_interval()
    assert np.isnan(lower).all()
    assert np.isnan(upper).all()


def half_a_tide():
    """A twin whose level 2 of a shackle was trained by water that ran west alone."""
    twin = stand_in_twin()
    model = twin.models.upper["shackle-1"]
    (process,) = model.rest.upper
    west = process.cases()[:, 1] < -0.1
    members = tuple(
        one.condition(one.x[west], one.observations()[west], noise_factor=one.noise_factor[west])
        for one in process.members
    )
    trained = replace(model, rest=replace(model.rest, own=(replace(process, members=members),)))
    return replace(twin, models=twin.models.with_level_2("shackle-1", trained)), process.cases()[
        west
    ]


def test_the_spread_of_level_2_has_no_step_at_the_edge_of_its_own_domain():
    twin = stand_in_twin()
    # From slack water out past the edge of the domain, which lies inside level 1's.
    speed = np.linspace(0.0, 0.95, 2000)
    velocity = speed[:, None] * np.array([np.cos(0.6), np.sin(0.6)])
    water = replace(Metocean.from_columns({}, len(speed)), current_velocity=velocity)
    answer = twin.predict(water)
    assert not answer.sensor_in_domain.all(axis=0).any()
    step = np.abs(np.diff(answer.sensor.std, axis=0)) / answer.sensor.std[:-1]
    assert step.max() < 0.05


def test_level_2_outside_its_own_domain_is_labelled_and_widened():
    twin, trained = half_a_tide()
    # The nearest water that trained it to a current to the east is the least westerly.
    north = np.clip(0.0, trained[:, 2].min(), trained[:, 2].max())
    velocity = [trained[len(trained) // 2, 1:3], [0.4, 0.0], [trained[:, 1].max(), north]]
    still = Metocean.of([SeaState(current_speed=0.0, current_to=0.0)] * 3)
    water = replace(still, current_velocity=np.array(velocity))
    answer, whole = twin.predict(water), stand_in_twin().predict(water)
    assert answer.in_domain.all()
    column = answer.sensor_names.index("shackle-1")
    line = twin.cage.shackles[0].bridle
    assert answer.sensor_in_domain[:2, column].tolist() == [True, False]
    assert answer.bridle_in_domain[:2, line].tolist() == [True, False]
    # The other sensors were trained all round, and level 1 alone answers the other bridles.
    others = [k for k in range(len(answer.sensor_names)) if k != column]
    assert answer.sensor_in_domain[:2, others].all()
    assert np.delete(answer.bridle_in_domain[:2], line, axis=1).all()
    np.testing.assert_allclose(answer.sensor.std[:, others], whole.sensor.std[:, others])
    step = abs(answer.sensor.mean[1, column] - answer.sensor.mean[2, column])
    assert answer.sensor.std[1, column] >= 0.99 * step > whole.sensor.std[1, column]
    assert answer.bridle_tension.std[1, line] >= 0.99 * step


def test_slack_and_fast_water_are_outside_what_trained_level_2():
    twin, trained = half_a_tide()
    least, most = trained[:, 0].min(), trained[:, 0].max()
    assert most < 0.9
    seas = [
        SeaState(current_speed=0.5 * least, current_to=270.0),
        SeaState(current_speed=0.99, current_to=270.0),
    ]
    answer = twin.predict(seas)
    column = answer.sensor_names.index("shackle-1")
    assert answer.in_domain.all()
    assert not answer.sensor_in_domain[:, column].any()


def test_faster_water_than_was_trained_is_answered_and_labelled():
    seas = [SeaState(current_speed=speed, current_to=40.0) for speed in (0.9, 1.0, 1.001, 1.3)]
    answer = stand_in_twin().predict(seas)
    assert answer.valid.all()
    assert answer.in_domain.tolist() == [True, True, False, False]
    assert answer.reason[1] == ""
    assert "up to 1.00 m/s" in answer.reason[3]


def test_beyond_the_edge_the_spread_holds_the_step_from_the_edge():
    seas = [SeaState(current_speed=speed, current_to=40.0) for speed in (1.0, 1.4)]
    answer = stand_in_twin().predict(seas)
    for prediction in (answer.sensor, answer.sensor_low, answer.bridle_tension):
        step = np.abs(prediction.mean[1] - prediction.mean[0])
        assert (prediction.std[1] >= step * 0.999).all()
        assert (prediction.std[1] > prediction.std[0]).all()
    moved = np.abs(answer.node_position[1] - answer.node_position[0]).max(axis=1)
    assert (answer.node_sigma[1] >= moved * 0.999).all()


def test_a_record_is_answered_row_by_row_as_step_answers_it():
    twin = stand_in_twin()
    buoy = stand_in_field(twin.cage, days=0.5).buoy
    batch = twin.predict_record(buoy)
    events = [one for one in replay(twin, buoy.samples()) if isinstance(one, Answered)]
    assert len(events) == len(buoy) == len(batch)
    stepped = np.vstack([numbers(event.answer) for event in events])
    np.testing.assert_allclose(numbers(batch), stepped, rtol=1e-6, atol=1e-6)


def test_a_row_that_failed_its_checks_has_no_number_and_says_which_value_failed():
    twin = stand_in_twin()
    buoy = stand_in_field(twin.cage, days=0.2).buoy
    flags = np.full(len(buoy), Flag.GOOD)
    flags[[2, 5]] = Flag.FAIL, Flag.SUSPECT
    answer = twin.predict_record(replace(buoy, flags={"current_to_deg": flags}))
    assert np.flatnonzero(~answer.valid).tolist() == [2]
    assert np.isnan(numbers(answer)[2]).all()
    assert answer.reason[2] == (
        "buoy-1: current_to_deg is flagged 4 (fail); there is no valid input."
    )


def test_a_record_without_an_input_of_the_twin_is_refused():
    twin = stand_in_twin()
    buoy = stand_in_field(twin.cage, days=0.2).buoy
    speed = {"current_speed_m_s": buoy.values["current_speed_m_s"]}
    with pytest.raises(InputError, match="has no current_to_deg"):
        twin.predict_record(replace(buoy, values=speed))


def test_no_rows_of_water_are_answered_with_none():
    twin, nothing = stand_in_twin(), Metocean.from_columns({}, 0)
    assert twin.predict(nothing).valid.tolist() == []
    assert twin.models.steepness(nothing).shape == (0, len(twin.sensor_names))
