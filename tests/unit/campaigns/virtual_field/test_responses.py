"""The true cage's answers between the settled ones."""

from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import TruthParameters
from seacage.campaigns._virtual_field._responses import Responses, true_responses
from seacage.conventions import SeacageError, towards
from stand_in import StandIn

SPEED = np.linspace(0.0, 1.5, 11)
DIRECTION = np.arange(16) * np.pi / 8.0
GROWTH = np.array([0.0, 0.5, 1.0])


def formula(speed: np.ndarray, direction: np.ndarray, growth: np.ndarray) -> np.ndarray:
    """A smooth answer that knows its direction, except at slack water."""
    lean = speed**2 * (1.0 + 0.3 * np.cos(direction - 1.0) + 0.2 * np.sin(2.0 * direction))
    return 15.0 - (1.0 + 0.5 * growth + 0.1 * growth**2) * lean


def tabulated() -> Responses:
    growth, speed, direction = np.meshgrid(GROWTH, SPEED, DIRECTION, indexing="ij")
    return Responses(
        speed=SPEED,
        direction=DIRECTION,
        growth=GROWTH,
        value=formula(speed, direction, growth)[..., None],
    )


def test_between_the_settled_currents_the_answers_follow_smoothly() -> None:
    rng = np.random.default_rng(0)
    speed, to = rng.uniform(0.0, 1.5, 500), rng.uniform(0.0, 360.0, 500)
    growth = rng.uniform(0.0, 1.0, 500)
    answers = tabulated().at(towards(speed, to), growth)
    # A cubic spline over 22.5 degrees leaves (pi / 8)^4 / 384 of the fourth derivative.
    exact = formula(speed, np.deg2rad(to), growth)
    np.testing.assert_allclose(answers[:, 0], exact, atol=0.01)


def test_settled_currents_are_answered_exactly() -> None:
    velocity = towards(np.full(16, SPEED[4]), np.rad2deg(DIRECTION))
    answers = tabulated().at(velocity, np.full(16, 0.5))
    np.testing.assert_allclose(answers[:, 0], tabulated().value[1, 4, :, 0], rtol=1e-12)


def test_north_has_no_seam_and_slack_water_no_corner() -> None:
    table = tabulated()
    either = towards(np.full(2, 0.8), np.array([359.999, 0.001]))
    west_and_east = table.at(either, np.full(2, 0.3))
    assert abs(np.diff(west_and_east[:, 0])[0]) < 1e-4
    through = np.column_stack([np.linspace(-0.01, 0.01, 5), np.zeros(5)])
    np.testing.assert_allclose(table.at(through, np.full(5, 0.3)), 15.0, atol=1e-3)


def test_currents_beyond_the_grid_count_as_its_largest() -> None:
    beyond = towards(np.array([1.5, 4.0]), np.array([30.0, 30.0]))
    at_most, more = tabulated().at(beyond, np.full(2, 1.0))[:, 0]
    assert at_most == more


def test_the_grid_is_settled_once_and_kept(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    hidden = TruthParameters.read()
    messages: list[tuple[str, int, int]] = []
    first, error = true_responses(
        small_cage, hidden, store=tmp_path, workers=1, progress=lambda *step: messages.append(step)
    )
    settled = len(stand_in.settled)
    assert settled <= 600
    assert messages[-1] == ("virtual field", settled, settled)
    assert [done for _, done, _ in messages] == sorted(done for _, done, _ in messages)
    assert np.abs(error[:, :3]).mean() < 0.01
    again, _ = true_responses(small_cage, hidden, store=tmp_path, workers=1)
    assert len(stand_in.settled) == settled
    np.testing.assert_array_equal(again.value, first.value)


@pytest.mark.slow
def test_another_cage_is_settled_anew_beside_the_first(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    true_responses(small_cage, TruthParameters.read(), store=tmp_path, workers=1)
    settled = len(stand_in.settled)
    heavier = small_cage.altered(tip={"weight_n": 9800.0})
    true_responses(heavier, TruthParameters.read(), store=tmp_path, workers=1)
    assert len(stand_in.settled) == 2 * settled


def test_a_true_cage_that_cannot_be_settled_is_refused(
    small_cage: Cage, stand_in: StandIn, tmp_path: Path
) -> None:
    stand_in.reach = 1.5
    with pytest.raises(SeacageError, match="cannot be settled"):
        true_responses(small_cage, TruthParameters.read(), store=tmp_path, workers=1)
