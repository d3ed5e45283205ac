"""Choice of training observations: spread over inputs and time, or the first in a row."""

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import InputError


def spread_design(
    place: Float[np.ndarray, "n axis"], count: int, *, seed: int
) -> Int[np.ndarray, " chosen"]:
    """Choose points as far from each other as can be, one after the other.

    Neighbours in time are the same sample twice: several hundred in a row add little to
    one and make intervals too narrow. With inputs and time among the axes the choice
    reaches rare inputs and every part of the time.

    ``place``: of each point, in axes that are alike important.
    ``count``: how many; all of them where there are no more.
    ``seed``: of the first one.

    Returns the rows of the chosen points, ascending.

    Source: farthest-point design: Johnson, Moore & Ylvisaker (1990), maximin distance.
    """
    if count < 1:
        raise InputError(f"spread_design: count = {count} chooses nothing. Give 1 or more.")
    points = len(place)
    if points <= count:
        return np.arange(points)
    chosen = [int(np.random.default_rng(seed).integers(points))]
    distance = np.full(points, np.inf)
    for _ in range(count - 1):
        distance = np.minimum(distance, np.sum((place - place[chosen[-1]]) ** 2, axis=1))
        chosen.append(int(np.argmax(distance)))
    return np.sort(np.array(chosen))


def window_design(
    time_s: Float[np.ndarray, " n"], *, span_s: float, least: int, most: int
) -> Int[np.ndarray, " chosen"]:
    """Choose the points of a window that begins with the first one.

    ``time_s``: ascending [s].
    ``span_s``: length of the window [s].
    ``least``: so many in a row where the window holds fewer, for a slow sensor.
    ``most``: at most so many, evenly spread over the window where it holds more.

    Returns the rows of the chosen points, ascending.
    """
    if not (span_s > 0.0 and 1 <= least <= most):
        raise InputError(
            f"window_design: a window of {span_s:g} s with {least} to {most} points cannot be. "
            "Give a length above 0 s, and least no more than most."
        )
    inside = int(np.searchsorted(time_s, time_s[0] + span_s)) if len(time_s) else 0
    held = min(max(inside, least), len(time_s))
    if held <= most:
        return np.arange(held)
    return np.unique(np.linspace(0, held - 1, most).round().astype(int))
