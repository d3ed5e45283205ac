"""The point of a net that is nearest to a point in the water."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import Rows

IntPerPair = Int[np.ndarray, " pair"]
IntTriangle3 = Int[np.ndarray, "triangle 3"]
Node3 = Float[np.ndarray, "node 3"]
Pair33 = Float[np.ndarray, "pair 3 3"]
Point3 = Float[np.ndarray, "point 3"]
Triangle3 = Float[np.ndarray, "triangle 3"]
Triangle33 = Float[np.ndarray, "triangle 3 3"]
CHUNK = 1000  # points answered at once: their distances to all triangles stay in the cache
ROUNDING = 1e-6  # of a distance that is the root of a difference of squares [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Nearest(Rows):
    """Where a net is nearest to each of some points."""

    distance: Float[np.ndarray, " point"]  # to the net [m]
    position: Point3  # the nearest point of the net [m]
    # Of the net there, a unit vector out of the cage; across an edge of two panels it is their
    # mean, at a node that of all around it, weighed by their angles
    normal: Point3
    # Whether the point lies behind that normal: within the cage, near its net
    inside: Bool[np.ndarray, " point"]
    # The three nodes around the nearest point, and the shares of it that sum to 1
    node: Int[np.ndarray, "point 3"]
    weight: Point3


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Surface:
    """Triangles, and what every question about them needs."""

    # Nodes of each triangle, counter-clockwise seen from outside
    corner: IntTriangle3
    # Of the three edges of each triangle: edge i leads from corner i to the next [m]
    start: Triangle33
    along: Triangle33
    # Of a ball around each triangle [m]
    centre: Triangle3
    radius: Float[np.ndarray, " triangle"]
    # Unit normals of the triangles, of their three edges, and of their three corners
    face: Triangle3
    edge: Triangle33
    vertex: Triangle33

    @classmethod
    def of(cls, node_position: Node3, corner: IntTriangle3) -> Self:
        start = node_position[corner]
        along = np.roll(start, -1, axis=1) - start
        centre = start.mean(axis=1)
        face = _unit(np.cross(along[:, 0], along[:, 1]))
        return cls(
            corner=corner,
            start=start,
            along=along,
            centre=centre,
            radius=np.linalg.norm(start - centre[:, None], axis=2).max(axis=1),
            face=face,
            edge=_edge_normals(corner, face),
            vertex=_vertex_normals(corner, along, face, nodes=len(node_position)),
        )


def nearest_on_net(
    point: Point3, node_position: Node3, panels: Int[np.ndarray, "panel 4"]
) -> Nearest:
    """Where a net is nearest to each point.

    The net is taken for flat triangles, two to a panel, cut from the panel's first corner to
    its third; where a panel is warped the other cut lies up to half its warp beside. Twines
    have no thickness, and a net has no top: whoever is above the collar is near its edge.

    ``point``: [m]. ``node_position``: one shape of the net [m]. ``panels``: corners
    counter-clockwise seen from outside; a triangle repeats its last.

    Source: Baerentzen & Aanaes (2005), "Signed distance computation using the angle weighted
    pseudonormal", for what is inside.
    """
    surface = _Surface.of(node_position, _triangles(panels))
    starts = range(0, max(len(point), 1), CHUNK)
    return Nearest.joined(*(_nearest(point[at : at + CHUNK], surface) for at in starts))


def _nearest(point: Point3, surface: _Surface) -> Nearest:
    which, triangle = _candidates(point, surface)
    touch = _Touch.of(point[which], triangle, surface)
    begin = np.searchsorted(which, np.arange(len(point)))
    least = np.minimum.reduceat(touch.distance, begin) if len(point) else touch.distance
    first = np.flatnonzero(touch.distance == least[which])
    first = first[np.unique(which[first], return_index=True)[1]]
    return touch.rows(first).answer(point, surface)


def _candidates(point: Point3, surface: _Surface) -> tuple[IntPerPair, IntPerPair]:
    """Pairs of a point and a triangle that may be the nearest to it, sorted by point.

    Left out is a triangle whose ball, or whose disc around its centre, lies farther off than
    the likeliest triangle itself.
    """
    to_centre2 = point @ (-2.0 * surface.centre.T)
    to_centre2 += np.sum(point**2, axis=1)[:, None]
    to_centre2 += np.sum(surface.centre**2, axis=1)
    np.maximum(to_centre2, 0.0, out=to_centre2)
    to_ball = np.sqrt(to_centre2)
    to_ball -= surface.radius
    likeliest = np.argmin(to_ball, axis=1)
    bound = _Touch.of(point, likeliest, surface).distance + ROUNDING
    which, triangle = np.divmod(np.flatnonzero(to_ball <= bound[:, None]), len(surface.corner))
    # A triangle lies in its plane, within its radius of its centre.
    height = np.einsum("pj,pj->p", point[which] - surface.centre[triangle], surface.face[triangle])
    beside = np.sqrt(np.maximum(to_centre2[which, triangle] - height**2, 0.0))
    short = np.maximum(beside - surface.radius[triangle] - ROUNDING, 0.0)
    near = height**2 + short**2 <= (bound[which] + ROUNDING) ** 2
    return which[near], triangle[near]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Touch(Rows):
    """Where one triangle is nearest to one point: ``spot`` 0-2 an edge, 3-5 a corner, 6 within."""

    triangle: IntPerPair
    position: Float[np.ndarray, "pair 3"]
    distance: Float[np.ndarray, " pair"]
    weight: Float[np.ndarray, "pair 3"]
    spot: IntPerPair

    @classmethod
    def of(
        cls, point: Float[np.ndarray, "pair 3"], triangle: IntPerPair, surface: _Surface
    ) -> Self:
        start, along = surface.start[triangle], surface.along[triangle]
        away = point[:, None] - start
        length2 = np.einsum("pij,pij->pi", along, along)
        share = np.clip(np.einsum("pij,pij->pi", away, along) / length2, 0.0, 1.0)
        foot = start + share[:, :, None] * along
        miss = point[:, None] - foot
        edge_distance2 = np.einsum("pij,pij->pi", miss, miss)
        best = np.argmin(edge_distance2, axis=1)
        rows = np.arange(len(point))
        share = share[rows, best]
        corner = np.where(share <= 0.0, best, (best + 1) % 3)
        weight = np.zeros((len(point), 3))
        weight[rows, best] = 1.0 - share
        weight[rows, (best + 1) % 3] += share
        edge = cls(
            triangle=triangle,
            position=foot[rows, best],
            distance=np.sqrt(edge_distance2[rows, best]),
            weight=weight,
            spot=np.where((share > 0.0) & (share < 1.0), best, 3 + corner),
        )
        return edge._or_within(away, along, surface)

    def _or_within(self, away: Pair33, along: Pair33, surface: _Surface) -> Self:
        """The foot of the perpendicular instead, where it falls within the triangle."""
        face = surface.face[self.triangle]
        height = np.einsum("pj,pj->p", away[:, 0], face)
        # Twice the area towards each edge; its share is the weight of the corner across.
        towards = np.einsum("pij,pj->pi", np.cross(along, away), face)
        within = np.flatnonzero((towards >= 0.0).all(axis=1) & (towards.sum(axis=1) > 0.0))
        area = towards[within].sum(axis=1, keepdims=True)
        first = surface.start[self.triangle[within], 0]
        self.position[within] = first + away[within, 0] - height[within, None] * face[within]
        self.distance[within] = np.abs(height[within])
        self.weight[within] = np.roll(towards[within], -1, axis=1) / area
        self.spot[within] = 6
        return self

    def answer(self, point: Point3, surface: _Surface) -> Nearest:
        """One nearest triangle to each point, in full."""
        normals = np.concatenate([surface.edge, surface.vertex, surface.face[:, None]], axis=1)
        normal = normals[self.triangle, self.spot]
        return Nearest(
            distance=self.distance,
            position=self.position,
            normal=normal,
            inside=np.einsum("pj,pj->p", point - self.position, normal) < 0.0,
            node=surface.corner[self.triangle],
            weight=self.weight,
        )


def _triangles(panels: Int[np.ndarray, "panel 4"]) -> IntTriangle3:
    both = np.concatenate([panels[:, [0, 1, 2]], panels[:, [0, 2, 3]]])
    ordered = np.sort(both, axis=1)
    return both[(ordered[:, 1:] > ordered[:, :-1]).all(axis=1)]


def _edge_normals(corner: IntTriangle3, face: Triangle3) -> Triangle33:
    ends = np.sort(np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, edge = np.unique(ends, axis=0, return_inverse=True)
    edge = np.ravel(edge)
    total = np.zeros((edge.max() + 1, 3))
    np.add.at(total, edge, np.repeat(face, 3, axis=0))
    return _unit(total)[edge].reshape(-1, 3, 3)


def _vertex_normals(
    corner: IntTriangle3, along: Triangle33, face: Triangle3, *, nodes: int
) -> Triangle33:
    out, back = _unit(along), -_unit(np.roll(along, 1, axis=1))
    angle = np.arccos(np.clip(np.einsum("tij,tij->ti", out, back), -1.0, 1.0))
    total = np.zeros((nodes, 3))
    np.add.at(total, corner, angle[:, :, None] * face[:, None])
    return _unit(total)[corner]


def _unit(vector: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n 3"]:
    length = np.linalg.norm(vector, axis=-1, keepdims=True)
    return vector / np.where(length > 0.0, length, 1.0)
