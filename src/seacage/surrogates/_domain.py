"""The features that a model has seen: outside them it guesses."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Bool, Float

from seacage.surrogates._prediction import check_inputs

MARGIN = 0.01  # of each feature's range: a sampled campaign never quite reaches its own limits


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Domain:
    """Range of each feature in the training.

    A box: it knows nothing of gaps inside it, and of a current its speed limits the corners.
    """

    # Smallest and largest value of each feature
    lower: Float[np.ndarray, " feature"]
    upper: Float[np.ndarray, " feature"]

    @classmethod
    def of(cls, x: Float[np.ndarray, "n feature"]) -> Self:
        """Learn from the training inputs."""
        x = check_inputs(x, what="Domain.of")
        return cls(lower=x.min(axis=0), upper=x.max(axis=0))

    def contains(self, x: Float[np.ndarray, "row feature"]) -> Bool[np.ndarray, " row"]:
        """Whether each row lies within every range, give or take 1 % of it."""
        x = check_inputs(x, what="Domain.contains", width=len(self.lower))
        margin = MARGIN * (self.upper - self.lower)
        return np.all((x >= self.lower - margin) & (x <= self.upper + margin), axis=1)
