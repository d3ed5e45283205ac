"""A small cage, and a simulator that answers at once."""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError, Result
from seacage.ocean import SeaState


@pytest.fixture(scope="session")
def small_cage() -> Cage:
    """Four rings of 16 spokes: quick, with every sensor in its place."""
    mesh = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
    return Cage.named("ace").altered(mesh=mesh)


class StandIn:
    """Settles by a formula: the net leans with the current, the bridles up-stream pull.

    Cases above 0.99 m/s diverge, those above 0.9 m/s do not converge.
    """

    def __init__(self) -> None:
        self.settled: list[SeaState] = []

    def settle(
        self, cage: Cage, seas: Sequence[SeaState], *, law: str, mean_waves: bool
    ) -> SimpleNamespace:
        if law not in ("kristiansen-faltinsen", "loland"):
            raise InputError(f"settle: no law {law!r}.")
        assert mean_waves
        self.settled.extend(seas)
        velocity = np.array([sea.current_velocity for sea in seas])
        speed = np.linalg.norm(velocity, axis=1)
        area = (0.2 + cage.netting.fouling_shallow) / 0.2
        position = np.tile(cage.design_position, (len(seas), 1, 1))
        depth = -position[..., 2]
        position[..., :2] += 10.0 * area * velocity[:, None] * depth[..., None] / 31.0
        position[..., 2] += 15.0 * area * (speed**2 / (1.0 + speed**2))[:, None] * depth / 31.0
        position[speed > 0.99] = np.nan
        away = cage.corner_position[cage.bridle_corner, :2] / 60.0
        tension = np.maximum(10e3 - 40e3 * area * speed[:, None] * (velocity @ away.T), 0.0)
        return SimpleNamespace(
            node_position=position,
            bridle_tension=tension,
            net_force=np.column_stack([5e4 * area * velocity, np.zeros(len(seas))]),
            volume=cage.volume(position),
            residual=np.where(speed > 0.9, 5.0, 0.1),
            result=np.select([speed > 0.99, speed > 0.9], [Result.DIVERGED, Result.NOT_CONVERGED]),
        )


@pytest.fixture
def stand_in(monkeypatch: pytest.MonkeyPatch) -> StandIn:
    """The formula in place of the solver, in this process."""
    simulator = StandIn()
    monkeypatch.setattr("seacage.dynamics.settle", simulator.settle, raising=False)
    return simulator
