"""A follower that answers at once, for tests of what surrounds the true one."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from seacage.cage import Cage
from seacage.dynamics import AbstractWeather, Followed


class Follower:
    """Answers by a formula: the net leans with the current where each mean begins.

    Stretches that begin at a second in ``loses`` leave the finite numbers.
    """

    def __init__(self) -> None:
        self.calls: list[dict[str, Any]] = []
        self.loses: set[float] = set()

    @property
    def starts(self) -> list[float]:
        """Of all stretches, in order."""
        return [start for call in self.calls for start in call["starts"]]

    def follow(
        self,
        cage: Cage,
        weathers: Sequence[AbstractWeather],
        starts: Sequence[float],
        **asked: Any,
    ) -> Followed:
        self.calls.append({"cage": cage, "weathers": weathers, "starts": list(starts), **asked})
        rest = cage.design_position
        time = np.array(starts)[:, None] + np.arange(0.0, asked["duration"], asked["every"])
        of_mean = round(asked["shape_every"] / asked["every"])
        current = np.array(
            [
                [weather.current(second)[0] for second in row]
                for weather, row in zip(weathers, time[:, ::of_mean].tolist(), strict=True)
            ]
        )
        means = np.concatenate([current, np.linalg.norm(current, axis=-1, keepdims=True)], axis=-1)
        lean = np.repeat(means, of_mean, axis=1)
        tension = 1e4 + 1e3 * lean[..., :1] * np.arange(cage.bridle_count)
        lost = np.isin(starts, list(self.loses))
        tension[lost] = np.nan
        asked["progress"]("follow", 1, 1)
        return Followed(
            time=time,
            watched_position=rest[list(asked["watched"])] + lean[:, :, None],
            bridle_tension=tension,
            # laid out by nodes first, as means that come one after another may be
            shape=np.moveaxis(rest[list(asked["shape_nodes"])][:, None, None] + means, 0, 2),
            lost_at=np.where(lost, np.array(starts) + 1.0, np.nan),
        )
