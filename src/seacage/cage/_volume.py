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

    Parameters
    ----------
    node_position
        [m].
    panels
        Corners counter-clockwise seen from outside.
    collar
        Nodes of the uppermost ring, counter-clockwise seen from above.
    """
    # Measured from the collar's centre, the fan that closes the top spans no volume.
    centre = node_position[..., collar, :].mean(axis=-2, keepdims=True)
    a, b, c, d = np.moveaxis((node_position - centre)[..., panels, :], -2, 0)
    splits = (
        _tetrahedra(a, b, c) + _tetrahedra(a, c, d) + _tetrahedra(a, b, d) + _tetrahedra(b, c, d)
    )
    # In C order, so that a case is summed in the same order alone as in company.
    return np.asarray(np.ascontiguousarray(splits).sum(axis=-1) / 2.0)


def _tetrahedra(
    a: Float[np.ndarray, "*n 3"], b: Float[np.ndarray, "*n 3"], c: Float[np.ndarray, "*n 3"]
) -> Float[np.ndarray, "*n"]:
    """Signed volumes of the tetrahedra with the origin [m3]."""
    # Written out, as NumPy's cross product takes most of its time to see what it was given.
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (np.moveaxis(one, -1, 0) for one in (a, b, c))
    triple = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return triple / 6.0
