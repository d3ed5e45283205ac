"""Symmetries of a net: turns and mirrorings that bring it onto itself, node by node."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import scipy
from jaxtyping import Float, Int

from seacage.conventions import InputError, ModelError
from seacage.surrogates._arrays import Arrays, array
from seacage.surrogates._features import vector_columns

Node3 = Float[np.ndarray, "node 3"]
RowNode3 = Float[np.ndarray, "row node 3"]
# Half the width over which neighbouring sectors pass into one another [rad]
BAND = math.radians(3.0)
SLACK_SPEED = 0.02  # below this the current's direction fades, and all images have a share [m/s]
COINCIDE = 0.01  # how far a node's image may lie from a node [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Symmetry:
    """The turns, and perhaps mirrorings, that bring a net onto itself.

    A sea state and its images, turned and mirrored likewise, shape a symmetric cage alike. So
    every case can be learned in one sector of the current's directions, which a fold of four
    with mirrors fills eight times as densely. That the net coincides with its images says
    nothing of its mooring and its parts: ``check_symmetry`` asks the shapes themselves.
    """

    centre: Float[np.ndarray, "2"]  # where the axis stands, (east, north) [m]
    # What each image does to a vector (east, north); the first leaves it as it is
    turn: Float[np.ndarray, "image 2 2"]
    # The node whose place in the net each node takes in each image
    source: Int[np.ndarray, "image node"]
    # Direction of the sector's middle from east, and half its width [rad]
    middle: float
    half: float

    @classmethod
    def of(cls, rest_position: Node3, *, fold: int, mirror: float | None = None) -> Self:
        """Find which node falls on which, or refuse where one falls on none.

        ``rest_position``: the net at rest, e.g. ``cage.design_position`` [m].
        ``fold``: how many turns in a full circle bring the net onto itself; 1 for mirrors alone.
        ``mirror``: direction of a vertical mirror plane, counter-clockwise from east [deg]; a fold
        of four has others every 45 degrees. None for no mirror.
        """
        if fold < 1 or (mirror is not None and not math.isfinite(mirror)):
            raise InputError(
                f"Symmetry: fold = {fold}, mirror = {mirror}; fold is a whole number from 1 and "
                "mirror a direction in degrees, or None."
            )
        plane = None if mirror is None else math.radians(mirror)
        centre = rest_position[:, :2].mean(axis=0)
        turn = _operations(fold, plane)
        half = math.pi / fold / (1 if plane is None else 2)
        return cls(
            centre=centre,
            turn=turn,
            source=np.stack([_match(rest_position, centre, one) for one in turn]),
            middle=0.0 if plane is None else plane + half,
            half=half,
        )

    def __len__(self) -> int:
        return len(self.turn)

    def at(self, position: Node3) -> Self:
        """The same turns and mirrorings, of other places [m]."""
        return replace(self, source=np.stack([_match(position, self.centre, t) for t in self.turn]))

    def turned(self, x: Float[np.ndarray, "row feature"], image: int) -> Float[np.ndarray, "_ _"]:
        """Features of an image of each sea state."""
        turned = x.copy()
        for at in vector_columns(x.shape[1]):
            turned[:, at] = x[:, at] @ self.turn[image].T
        return turned

    def moved(self, node_position: RowNode3, image: int) -> RowNode3:
        """An image of each shape [m]."""
        moved = node_position[:, self.source[image]]
        moved[..., :2] = self.centre + (moved[..., :2] - self.centre) @ self.turn[image].T
        return moved

    def back(self, image: int) -> int:
        """The image that undoes this one."""
        undone = self.turn @ self.turn[image] - np.eye(2)
        return int(np.argmin(np.abs(undone).max(axis=(1, 2))))

    def home(self, x: Float[np.ndarray, "row feature"]) -> Int[np.ndarray, " row"]:
        """The image of each sea state whose current goes nearest to the sector's middle."""
        return np.argmin(self._off_middle(x), axis=1)

    def shares(self, x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row image"]:
        """Share of each image in the answer to each sea state; they sum to 1.

        One image has all, but for a band where two sectors meet and for slack water. Without
        those the shape would jump where another image takes over.
        """
        inside = _smooth(0.5 + (self.half - self._off_middle(x)) / (2.0 * BAND))
        steady = _smooth(x[:, :1] / SLACK_SPEED)
        shares = steady * inside + (1.0 - steady) / len(self)
        return shares / shares.sum(axis=1, keepdims=True)

    def to_arrays(self) -> Arrays:
        """Everything that ``from_arrays`` needs."""
        return {
            "symmetry_centre": self.centre,
            "symmetry_turn": self.turn,
            "symmetry_source": self.source.astype(np.float64),
            "symmetry_sector": np.array([self.middle, self.half]),
        }

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, np.ndarray], *, nodes: int) -> Self:
        """The symmetry that ``to_arrays`` described.

        Raises ModelError: an array is missing or of another shape, or names nodes that do not
        exist.
        """
        turn = array(arrays, "symmetry_turn", None, 2, 2)
        source = array(arrays, "symmetry_source", len(turn), nodes)
        if not np.array_equal(np.sort(source, axis=1), np.tile(np.arange(nodes), (len(turn), 1))):
            raise ModelError(
                "The saved model's symmetry does not lead every node to one. Train the model again."
            )
        middle, half = array(arrays, "symmetry_sector", 2)
        return cls(
            centre=array(arrays, "symmetry_centre", 2),
            turn=turn,
            source=source.astype(np.int64),
            middle=float(middle),
            half=float(half),
        )

    def _off_middle(self, x: Float[np.ndarray, "row feature"]) -> Float[np.ndarray, "row image"]:
        """Angle between each image of the current and the sector's middle [rad]."""
        images = np.einsum("gij,rj->rgi", self.turn, x[:, 1:3])
        along = np.array([math.cos(self.middle), math.sin(self.middle)])
        across = np.array([-along[1], along[0]])
        return np.abs(np.arctan2(images @ across, images @ along))


def _operations(fold: int, plane: float | None) -> Float[np.ndarray, "image 2 2"]:
    angle = 2.0 * np.pi * np.arange(fold) / fold
    turns = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turns = np.moveaxis(turns, 2, 0)
    if plane is None:
        return turns
    cos, sin = math.cos(2.0 * plane), math.sin(2.0 * plane)
    return np.concatenate([turns, turns @ np.array([[cos, sin], [sin, -cos]])])


def _match(
    position: Node3, centre: Float[np.ndarray, "2"], turn: Float[np.ndarray, "2 2"]
) -> Int[np.ndarray, " node"]:
    """Which node falls on each node."""
    image = position.copy()
    image[:, :2] = centre + (position[:, :2] - centre) @ turn.T
    distance, nearest = scipy.spatial.KDTree(image).query(position)
    source = np.asarray(nearest)
    if distance.max() > COINCIDE or len(np.unique(source)) < len(source):
        node = int(np.argmax(distance))
        angle = math.degrees(math.atan2(turn[1, 0], turn[0, 0]))
        act = f"turned by {angle:.4g} deg" if np.linalg.det(turn) > 0.0 else "mirrored"
        raise InputError(
            f"Symmetry: {act}, the net does not fall on itself: node {node} is "
            f"{distance[node]:.3g} m from the nearest. Give another fold or mirror, or none."
        )
    return source


def _smooth(share: Float[np.ndarray, "row _"]) -> Float[np.ndarray, "row _"]:
    """From 0 to 1 without a kink."""
    held = np.clip(share, 0.0, 1.0)
    return held * held * (3.0 - 2.0 * held)
