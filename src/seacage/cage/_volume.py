"""The volume that a net encloses."""

import numpy as np
from jaxtyping import Float, Int


def enclosed_volume(
    node_position: Float[np.ndarray, "*case node 3"],
    panels: Int[np.ndarray, "panel 4"],
    collar: Int[np.ndarray, " spoke"],
) -> Float[np.ndarray, "*case"]:
    """Volume inside the net, closed by the polygon of the collar [m3].

    By the divergence theorem over triangles; each quadrilateral is the mean of its two
    splits, so that the answer does not depend on how it is cut.

    ``node_position``: [m]. ``panels``: corners counter-clockwise seen from outside. ``collar``:
    nodes of the uppermost ring, counter-clockwise seen from above.
    """
    # Measured from the collar's centre, the fan that closes the top spans no volume. In C order,
    # so that a case is summed in the same order alone as in company.
    centre = node_position[..., collar, :].mean(axis=-2, keepdims=True)
    axes = np.ascontiguousarray(np.moveaxis(node_position - centre, -1, 0))
    a, b, c, d = np.moveaxis(np.take(axes, panels.T, axis=-1), -2, 0)
    # One split is (d - b) · (a × c), the other (a - c) · (b × d), each six times its volume.
    twice = _triple_product(a - c, b, d) - _triple_product(b - d, a, c)
    return np.asarray(twice.sum(axis=-1) / 12.0)


def _triple_product(
    u: Float[np.ndarray, "3 *n"], v: Float[np.ndarray, "3 *n"], w: Float[np.ndarray, "3 *n"]
) -> Float[np.ndarray, "*n"]:
    # Written out, as NumPy's cross product takes most of its time to see what it was given.
    (ux, uy, uz), (vx, vy, vz), (wx, wy, wz) = u, v, w
    return ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)
