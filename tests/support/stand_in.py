"""A simulator that answers at once, for tests of what surrounds the true one."""

import math
from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np

from line_loads import bare_line_loads, bare_loads
from seacage.cage import Cage, mooring_lines
from seacage.conventions import InputError, Result
from seacage.dynamics import History, Statistics
from seacage.ocean import SeaState


class StandIn:
    """Answers by a formula: the net leans with the current, the bridles up-stream pull.

    Cases faster than its reach diverge; settled, those a little slower do not converge. Cases
    faster than it is known for are outside its validity.
    """

    def __init__(self) -> None:
        self.reach = self.known = math.inf
        self.refuses = False
        self.settled: list[SeaState] = []

    def settle(
        self, cage: Cage, seas: Sequence[SeaState], *, law: str, mean_waves: bool, **_: object
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
        result = np.where(speed > self.known, Result.OUTSIDE_VALIDITY, Result.CONVERGED)
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

    def simulate(
        self,
        cage: Cage,
        sea: Sequence[SeaState],
        *,
        seed: Sequence[int],
        quantile_levels: Sequence[float],
        second_moment: bool,
        law: str,
        mooring: str = "catenary",
        **_: object,
    ) -> History:
        """The settled cage, swaying by what the seed draws."""
        settled = self.settle(cage, sea, law=law, mean_waves=True)
        lost = settled.result == Result.DIVERGED
        sway = np.array([np.random.default_rng(one).uniform(0.1, 1.0) for one in seed])
        sway[lost] = np.nan
        node = _swaying(settled.node_position, sway, quantile_levels)
        away = (settled.node_position - cage.design_position).reshape(len(sea), -1)
        moment = (
            away[:, :, None] * away[:, None, :] if second_moment else np.empty((len(sea), 0, 0))
        )
        nobody = np.empty((len(sea), 0, 0))
        bridle = _swaying(settled.bridle_tension, sway, quantile_levels)
        names = mooring_lines(cage, anchored=mooring == "catenary").names
        others = np.full((len(sea), len(names) - cage.bridle_count), 2e4)
        tension = np.concatenate([settled.bridle_tension, others], axis=1)
        return History(
            time=np.empty(0),
            nodes=np.empty(0, int),
            node_position=np.empty((len(sea), 0, 0, 3)),
            bridle_tension=nobody,
            line_tension=nobody,
            surface_elevation=np.empty((len(sea), 0)),
            node=node,
            bridle=bridle,
            net_force=_swaying(settled.net_force, sway, quantile_levels),
            volume=_swaying(settled.volume, sway, quantile_levels),
            lines=bare_line_loads(_swaying(tension, sway, quantile_levels)),
            **bare_loads(len(sea)),
            node_displacement=settled.node_position - cage.design_position,
            volume_fraction=np.ones(len(sea)),
            quantile_levels=np.array(quantile_levels),
            second_moment=moment,
            result=np.where(settled.result == Result.NOT_CONVERGED, 0, settled.result),
            hs_left_out=np.zeros(len(sea)),
            warnings=(),
            diverged_at=np.where(lost, 12.5, np.nan),
        )


def _swaying(mean: np.ndarray, sway: np.ndarray, levels: Sequence[float]) -> Statistics:
    each = sway.reshape(-1, *[1] * (mean.ndim - 1))
    return Statistics(
        mean=mean + 0.0 * each,
        std=np.broadcast_to(each, mean.shape),
        minimum=mean - 2.0 * each,
        maximum=mean + 2.0 * each,
        quantile=np.stack([mean + (4.0 * level - 2.0) * each for level in levels], axis=1),
    )
