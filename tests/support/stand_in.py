"""A simulator that answers at once, for tests of what surrounds the true one."""

import math
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np

from seacage.cage import Cage
from seacage.conventions import InputError, Result
from seacage.ocean import SeaState


class StandIn:
    """Settles by a formula: the net leans with the current, the bridles up-stream pull.

    Cases faster than its reach diverge, those a little slower do not converge.
    """

    def __init__(self) -> None:
        self.reach = math.inf
        self.refuses = False
        self.settled: list[SeaState] = []

    def settle(
        self, cage: Cage, seas: Sequence[SeaState], *, law: str, mean_waves: bool
    ) -> SimpleNamespace:
        if self.refuses:
            raise InputError("This cage cannot float.")
        assert mean_waves
        self.settled.extend(seas)
        velocity = np.array([sea.current_velocity for sea in seas])
        speed = np.linalg.norm(velocity, axis=1)
        area = (0.2 + cage.netting.fouling_shallow) / 0.2 * (1.2 if law == "loland" else 1.0)
        position = np.tile(cage.design_position, (len(seas), 1, 1))
        depth = -position[..., 2]
        position[..., :2] += 10.0 * area * velocity[:, None] * depth[..., None] / 31.0
        position[..., 2] += 15.0 * area * (speed**2 / (1.0 + speed**2))[:, None] * depth / 31.0
        position[speed > self.reach] = np.nan
        away = cage.corner_position[cage.bridle_corner, :2] / 60.0
        tension = np.maximum(10e3 - 40e3 * area * speed[:, None] * (velocity @ away.T), 0.0)
        result = np.full(len(seas), Result.CONVERGED)
        result[speed > 0.9 * self.reach] = Result.NOT_CONVERGED
        result[speed > self.reach] = Result.DIVERGED
        return SimpleNamespace(
            node_position=position,
            bridle_tension=tension,
            net_force=np.column_stack([5e4 * area * velocity, np.zeros(len(seas))]),
            volume=cage.volume(position),
            residual=np.full(len(seas), 0.1),
            result=result,
        )
