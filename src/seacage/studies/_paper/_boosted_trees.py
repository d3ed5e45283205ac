"""Gradient boosting of regression trees (Friedman, 2001), for a baseline without physics."""

import numpy as np
from jaxtyping import Float

# As by default in scikit-learn's HistGradientBoostingRegressor, whose 31 leaves are a depth of 5
ROUNDS, RATE, DEPTH, LEAST = 100, 0.1, 5, 20  # trees, share of each, splits deep, samples of a leaf

Samples = Float[np.ndarray, "sample feature"]
Series = Float[np.ndarray, " sample"]
Places = Float[np.ndarray, "place feature"]
AtPlaces = Float[np.ndarray, " place"]


def predict_by_trees(x: Samples, y: Series, at: Places) -> AtPlaces:
    """Predictions at other features, of trees that each fit what those before leave of ``y``."""
    found, there = np.full(len(y), y.mean()), np.full(len(at), y.mean())
    for _ in range(ROUNDS):
        own, others = _grow(x, y - found, at, DEPTH)
        found, there = found + RATE * own, there + RATE * others
    return there


def _grow(x: Samples, y: Series, at: Places, depth: int) -> tuple[Series, AtPlaces]:
    """Values of one tree at the features that it grows from, and at others."""
    own, there = np.full(len(y), y.mean()), np.full(len(at), y.mean())
    split = _best_split(x, y) if depth and len(y) >= 2 * LEAST else None
    if split is not None:
        feature, most = split
        left, left_there = x[:, feature] <= most, at[:, feature] <= most
        for some, others in ((left, left_there), (~left, ~left_there)):
            own[some], there[others] = _grow(x[some], y[some], at[others], depth - 1)
    return own, there


def _best_split(x: Samples, y: Series) -> tuple[int, float] | None:
    """Feature, and the end of its left part; None where all samples of a part are alike."""
    order = np.argsort(x, axis=0, kind="stable")
    ascending = np.take_along_axis(x, order, axis=0)
    left, count = np.cumsum(y[order], axis=0)[:-1], np.arange(1, len(y))[:, None]
    gain = left**2 / count + (y.sum() - left) ** 2 / (len(y) - count)
    allowed = (np.diff(ascending, axis=0) > 0.0) & (np.minimum(count, len(y) - count) >= LEAST)
    if not allowed.any():
        return None
    row, feature = divmod(int(np.argmax(np.where(allowed, gain, -np.inf))), x.shape[1])
    return feature, float(ascending[row : row + 2, feature].mean())
