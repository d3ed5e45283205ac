from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest

from page_frames import decode_frame
from seacage.ocean import SeaState
from seacage.service._live._answers import state_of, topology_of
from seacage.service._live._frame import Flags, frame_of
from seacage.testing import stand_in_twin
from seacage.twin import Answered, Metocean

NOON = datetime(2020, 2, 1, 12, tzinfo=UTC)


@pytest.fixture(scope="module")
def twin():
    return stand_in_twin()


@pytest.fixture(scope="module")
def rest(twin):
    return np.array(topology_of("ace", twin, speed=1.0).rest_position_m)


def answered_by(twin, speed):
    water = Metocean.of(SeaState(current_speed=speed, current_to=90.0))
    return Answered(t=NOON, answer=twin.predict(water), metocean=water, input_age_s=1.0)


def framed(twin, rest, answered, **how):
    state = state_of("ace", twin, answered, twin.start())
    return state, frame_of(state, answered, rest, **how)


@pytest.mark.parametrize("speed", [0.1, 0.5, 0.9])
def test_a_frame_holds_the_net_to_half_a_unit(twin, rest, speed):
    answered = answered_by(twin, speed)
    state, message = framed(twin, rest, answered)
    frame = decode_frame(message)
    # Half a unit, and what single precision loses of the unit over 32,767 of them.
    near = {"rtol": 1e-6, "atol": 0.501 * frame.unit}
    np.testing.assert_allclose(frame.displacement, answered.answer.node_position[0] - rest, **near)
    assert frame.unit < 1e-3, "finer than a millimetre, while the net moves by metres"
    assert frame.state == state.model_dump(mode="json")
    assert frame.t_ms == NOON.timestamp() * 1e3
    assert (frame.version, frame.flags) == (2, Flags.VALID | Flags.IN_DOMAIN)


def test_a_net_that_no_sensor_trained_has_no_spread_in_a_frame(twin, rest):
    alone = replace(twin, models=twin.models.level_1)
    state, message = framed(alone, rest, answered_by(alone, 0.5))
    frame = decode_frame(message)
    assert frame.flags & Flags.NO_SPREAD
    assert frame.sigma.size == 0
    assert len(frame.displacement) == len(rest)
    assert "No sensor has trained level 2" in state.shape.interval_reason
    assert (state.volume_fraction_lower, state.volume_fraction_upper) == (None, None)


def test_a_spread_that_is_known_is_in_the_frame(twin, rest):
    answered = answered_by(twin, 0.5)
    state, message = framed(twin, rest, answered)
    frame = decode_frame(message)
    assert not frame.flags & Flags.NO_SPREAD
    near = {"rtol": 1e-6, "atol": 0.501 * frame.sigma_unit}
    np.testing.assert_allclose(frame.sigma, answered.answer.node_std[0].max(axis=1), **near)
    assert state.volume_fraction_lower < state.volume_fraction < state.volume_fraction_upper


@pytest.mark.parametrize("metres", [40.0, 1e4, 0.0])
def test_a_net_however_far_is_never_cut_off(twin, rest, metres):
    answered = answered_by(twin, 0.5)
    _, message = framed(twin, answered.answer.node_position[0] - metres, answered)
    frame = decode_frame(message)
    np.testing.assert_allclose(frame.displacement, metres, rtol=1e-6)


def test_without_valid_input_a_frame_holds_no_net(twin, rest):
    unknown = Metocean.from_columns({}, 1)
    answered = Answered(t=NOON, answer=twin.predict(unknown), metocean=None, input_age_s=None)
    frame = decode_frame(framed(twin, rest, answered)[1])
    assert not frame.flags & Flags.VALID
    assert frame.displacement.size == frame.sigma.size == 0


def test_a_frame_says_that_it_is_of_the_past_or_of_what_would_be(twin, rest):
    _, message = framed(twin, rest, answered_by(twin, 0.5), about=Flags.PAST | Flags.WHAT_IF)
    about = Flags.PAST | Flags.WHAT_IF
    assert decode_frame(message).flags == Flags.VALID | Flags.IN_DOMAIN | about


def test_a_topology_is_known_by_a_hash_of_all_it_says(twin):
    first, again = (topology_of("ace", twin, speed=1.0) for _ in range(2))
    assert first.topology_id == again.topology_id
    assert first.topology_id != topology_of("ice", twin, speed=1.0).topology_id
