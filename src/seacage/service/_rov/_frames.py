"""Points in the frames that pilots use, and back."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.service._schemas._clearance import ClearanceQuery, FrameName, Place

Points = Float[np.ndarray, "point 3"]


def local_points(cage: Cage, query: ClearanceQuery) -> Points:
    """East, north and up of the cage's centre [m].

    Raises InputError: latitudes for a cage that does not say where it lies.
    """
    if query.places is not None:
        rows = [[one.latitude_deg, one.longitude_deg, one.depth_m] for one in query.places]
        latitude, longitude, depth = np.array(rows, dtype=float).T
        return cage.plane.local(latitude, longitude, depth)
    return in_frame(query.frame, np.array(query.points_m, dtype=float).reshape(-1, 3))


def in_frame(frame: FrameName, vector: Points) -> Points:
    """Turn east, north, up into a frame's own axes, or those back: the two are one turn."""
    if frame == "ned":
        return vector[:, [1, 0, 2]] * np.array([1.0, 1.0, -1.0])
    return vector


def places_of(cage: Cage, frame: FrameName, position: Points) -> Sequence[Place | None]:
    """Latitude, longitude and depth, where a frame has them."""
    if frame != "wgs84":
        return [None] * len(position)
    # A tenth of a microdegree is a centimetre.
    columns = [
        one.round(decimals).tolist()
        for one, decimals in zip(cage.plane.geographic(position), (8, 8, 3), strict=True)
    ]
    return [
        Place(latitude_deg=latitude, longitude_deg=longitude, depth_m=depth)
        for latitude, longitude, depth in zip(*columns, strict=True)
    ]
