"""The current's frame: shapes and waves seen along the current, and slack water from the earth."""

import numpy as np
from jaxtyping import Float

from seacage.surrogates._features import vector_columns

_PAIRS = [(i, j) for i in range(4) for j in range(i, 4)]

SLACK_SPEED = 0.1
"""Above this all is seen along the current, below it partly from the earth [m/s].

A frame that turns with the current has no direction in slack water, and whatever is learned in
it alone would jump there. A shape is therefore learned in both frames, from the earth only where
that is asked, and each has its share in the answer.
"""


def seen_along(x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row seen"]:
    """Features with each wave vector as two: its earthly part, and its part along the current."""
    share = _share(x)[:, None]
    columns = [x]
    for at in vector_columns(x.shape[1])[1:]:
        wave = x[:, at]
        along = np.concatenate([wave, np.zeros((len(x), 1))], axis=1)[:, None]
        relative = _rotated(x, along, back=True)[:, 0, :2]
        columns = [x[:, : at.start], (1.0 - share) * wave, share * relative, x[:, at.stop :]]
    return np.hstack(columns)


def parted(
    x: Float[np.ndarray, "row feature"], displacement: Float[np.ndarray, "row node 3"]
) -> Float[np.ndarray, "row 2 node 3"]:
    """Displacements from the earth, fading out as the current rises, and along the current [m]."""
    seen = _fading(x)[:, None, None] * displacement
    return np.stack([seen, _rotated(x, displacement, back=True)], axis=1)


def whole(
    x: Float[np.ndarray, "row feature"], parts: Float[np.ndarray, "row 2 node 3"]
) -> Float[np.ndarray, "row node 3"]:
    """The displacements that ``parted`` took apart [m]."""
    earthly, along = _says(x)
    return earthly[:, None, None] * parts[:, 0] + along[:, None, None] * _rotated(
        x, parts[:, 1], back=False
    )


def moment_products(
    direction: Float[np.ndarray, "mode part node 3"],
) -> Float[np.ndarray, "mode product node"]:
    """Products of the coordinates of modes, of which variances of nodes are sums.

    Of one part: x x, y y, z z, x y. Of two: those of (x, y) of both parts with one another, row
    by row of the upper triangle, then those of z.
    """
    parts = direction.shape[1]
    x, y, z = np.moveaxis(direction, 3, 0)
    if parts == 1:
        products = [x * x, y * y, z * z, x * y]
        return np.concatenate(products, axis=1)
    horizontal = np.stack([x, y], axis=2).reshape(len(x), 4, -1)
    flat = [horizontal[:, i] * horizontal[:, j] for i, j in _PAIRS]
    upright = [z[:, 0] * z[:, 0], z[:, 0] * z[:, 1], z[:, 1] * z[:, 1]]
    return np.stack([*flat, *upright], axis=1)


def whole_moments(
    x: Float[np.ndarray, "row feature"], moments: Float[np.ndarray, "row 13 node"]
) -> Float[np.ndarray, "row 4 node"]:
    """Second moments x x, y y, z z, x y of whole displacements from those of their parts."""
    i, j = np.transpose(_PAIRS)
    full = np.empty((len(x), 4, 4, moments.shape[2]))
    full[:, i, j] = full[:, j, i] = moments[:, :10]
    earthly, along = (share[:, None, None] for share in _says(x))
    units = np.broadcast_to(np.eye(2, 3), (len(x), 2, 3))
    turn = np.swapaxes(_rotated(x, units, back=False)[..., :2], 1, 2)
    both = np.concatenate([earthly * np.eye(2), along * turn], axis=2)
    xx, xy, _, yy = np.einsum("rik,rklm,rjl->ijrm", both, full, both, optimize=True).reshape(
        4, len(x), -1
    )
    share = np.concatenate([earthly**2, 2.0 * earthly * along, along**2], axis=1)
    return np.stack([xx, yy, np.sum(share * moments[:, 10:], axis=1), xy], axis=1)


def _share(x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, " row"]:
    """Of the current's frame."""
    return _smooth(x[:, 0] / SLACK_SPEED)


def _fading(x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, " row"]:
    """How much of a displacement is learned from the earth: at least half where it is asked."""
    return 1.0 - _smooth(0.5 * x[:, 0] / SLACK_SPEED)


def _says(
    x: Float[np.ndarray, "row feature"],
) -> tuple[Float[np.ndarray, " row"], Float[np.ndarray, " row"]]:
    """What the earthly part and the part along the current are multiplied by."""
    share = _share(x)
    return (1.0 - share) / np.where(share < 1.0, _fading(x), 1.0), share


def _smooth(share: Float[np.ndarray, " row"]) -> Float[np.ndarray, " row"]:
    """From 0 to 1 without a kink."""
    held = np.clip(share, 0.0, 1.0)
    return held * held * (3.0 - 2.0 * held)


def _rotated(
    x: Float[np.ndarray, "row feature"], vector: Float[np.ndarray, "row node 3"], *, back: bool
) -> Float[np.ndarray, "row node 3"]:
    """Vectors turned from east to the current's direction, or back."""
    speed = np.hypot(x[:, 1], x[:, 2])
    cos = np.where(speed > 0.0, x[:, 1], 1.0) / np.where(speed > 0.0, speed, 1.0)
    sin = x[:, 2] / np.where(speed > 0.0, speed, 1.0) * (-1.0 if back else 1.0)
    rotated = vector.copy()
    rotated[..., 0] = cos[:, None] * vector[..., 0] - sin[:, None] * vector[..., 1]
    rotated[..., 1] = sin[:, None] * vector[..., 0] + cos[:, None] * vector[..., 1]
    return rotated
