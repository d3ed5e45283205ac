"""Values in even steps of time."""

import numpy as np
import pytest

from seacage.campaigns._virtual_field._weather import Even
from seacage.conventions import InputError

WHOLE = Even(step=2.0, values=np.random.default_rng(0).normal(size=(50, 3)))


def test_it_is_straight_between_its_steps() -> None:
    line = Even(step=2.0, values=np.arange(5.0)[:, None])
    np.testing.assert_allclose(line.at(np.array([0.0, 1.0, 3.5, 8.0]))[:, 0], [0, 0.5, 1.75, 4])
    np.testing.assert_allclose(line.at(3.0), [1.5])


def test_beyond_its_ends_it_holds_or_goes_straight_on() -> None:
    bent = Even(step=1.0, values=np.array([[0.0], [1.0], [4.0]]))
    beyond = np.array([-2.0, 4.0])
    np.testing.assert_allclose(bent.at(beyond)[:, 0], [0.0, 4.0])
    np.testing.assert_allclose(bent.at(beyond, held=False)[:, 0], [-2.0, 10.0])


@pytest.mark.parametrize(("start", "end"), [(20.0, 40.0), (21.3, 21.4), (-5.0, 6.0), (90.0, 200.0)])
def test_a_cut_reads_bit_for_bit_as_the_whole(start: float, end: float) -> None:
    second = np.linspace(start, end, 33)
    for cut in (WHOLE.between(start, end), WHOLE.between(start - 9.0, end).between(start, end)):
        assert len(cut.values) <= (end - start) / 2.0 + 3.0
        for held in (True, False):
            there = WHOLE.at(second, held=held)
            np.testing.assert_array_equal(cut.at(second, held=held), there)


@pytest.mark.parametrize("second", [19.9, 40.1])
def test_what_was_cut_off_is_refused(second: float) -> None:
    with pytest.raises(InputError, match=r"not among those kept, 20 to 40"):
        WHOLE.between(20.0, 40.0).at(second)


def test_a_cut_does_not_hold_on_to_the_whole() -> None:
    assert WHOLE.between(20.0, 40.0).values.base is None
