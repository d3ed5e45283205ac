"""A small cage, and a simulator that answers at once."""

import pytest

from seacage.cage import Cage
from stand_in import StandIn


@pytest.fixture(scope="session")
def small_cage() -> Cage:
    """Four rings of 16 spokes: quick, with every sensor in its place."""
    mesh = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
    return Cage.named("ace").altered(mesh=mesh)


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> StandIn:
    """The formula in place of the solver, in this process."""
    simulator = StandIn()
    monkeypatch.setattr("seacage.campaigns._cases.settle", simulator.settle)
    monkeypatch.setattr("seacage.campaigns._cases.simulate", simulator.simulate)
    return simulator
