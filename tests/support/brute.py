"""Distances to a net the slow way: every point against every triangle, one triangle at a time."""

import numpy as np
from jaxtyping import Float, Int


def brute_distance(
    point: Float[np.ndarray, "point 3"],
    shape: Float[np.ndarray, "node 3"],
    panels: Int[np.ndarray, "panel 4"],
) -> Float[np.ndarray, " point"]:
    """Distance of each point to the nearest of all triangles [m]."""
    cut = np.concatenate([panels[:, [0, 1, 2]], panels[:, [0, 2, 3]]])
    least = np.full(len(point), np.inf)
    for a, b, c in shape[cut]:
        if np.linalg.norm(np.cross(b - a, c - a)) > 0.0:
            least = np.minimum(least, _to_triangle(point, a, b, c))
    return least


def _to_triangle(
    point: Float[np.ndarray, "point 3"],
    a: Float[np.ndarray, " 3"],
    b: Float[np.ndarray, " 3"],
    c: Float[np.ndarray, " 3"],
) -> Float[np.ndarray, " point"]:
    sides = np.column_stack([b - a, c - a])
    u, v = np.linalg.solve(sides.T @ sides, sides.T @ (point - a).T)
    off_plane = np.linalg.norm(point - a - np.outer(u, b - a) - np.outer(v, c - a), axis=1)
    within = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    edges = [_to_segment(point, *ends) for ends in ((a, b), (b, c), (c, a))]
    return np.where(within, off_plane, np.min(edges, axis=0))


def _to_segment(
    point: Float[np.ndarray, "point 3"], a: Float[np.ndarray, " 3"], b: Float[np.ndarray, " 3"]
) -> Float[np.ndarray, " point"]:
    share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    return np.linalg.norm(point - a - np.outer(share, b - a), axis=1)
