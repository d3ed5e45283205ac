"""What is typed for MoorPy and MoorDyn is what they answer, where they are installed."""

import numpy as np
import pytest

from validation import _peers
from validation.mooring_peers import ACE, AMPLITUDE, AT_REST, DRIVEN


def test_moorpy_answers_what_is_typed():
    pytest.importorskip("moorpy")
    found = _peers.rest_by_moorpy(ACE)
    assert found.keys() == AT_REST.keys()
    np.testing.assert_allclose(list(found.values()), list(AT_REST.values()), rtol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("period", DRIVEN)
def test_moordyn_answers_what_is_typed(period):
    pytest.importorskip("moordyn")
    found = _peers.driven_by_moordyn(ACE, amplitude=AMPLITUDE, period=period)
    # its time step is cut by the segments' own, and its least tension is the most sensitive
    np.testing.assert_allclose(found, DRIVEN[period], rtol=2e-3)
