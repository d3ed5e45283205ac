"""Inspection path of a camera along the net: rows or a spiral at a stand-off."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Nearest
from seacage.conventions import InputError, compass
from seacage.twin._rov._clearance import Clearance
from seacage.twin._rov._predicted_net import PredictedNet

PerWaypoint = Float[np.ndarray, " waypoint"]
RingSpoke3 = Float[np.ndarray, "ring spoke 3"]

Side = Literal["inside", "outside"]
"""Side of the net that an inspection swims on."""
Pattern = Literal["rows", "spiral"]
"""Way of an inspection along the net."""
MOST_WAYPOINTS = 10_000  # waypoints at most
_ROUNDS = 8  # of moving waypoints to their stand-off; in a corner of the net each helps a little
_TOO_NEAR = 0.9  # least distance over the stand-off; a waypoint with less is left out
_STRIDES = 3.0  # largest distance of two neighbours of a part, in steps or rows


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class InspectionPath:
    """Waypoints along a net."""

    position: Float[np.ndarray, "waypoint 3"]  # east, north, up [m]
    facing: Float[np.ndarray, "waypoint 3"]  # unit vector from each waypoint to the net
    # The row, or turn of the spiral, that it belongs to, from the top
    row: Int[np.ndarray, " waypoint"]
    # Number of its part: a new one begins where waypoints were left out, or where the straight line
    # to the next would come nearer to the net than half the stand-off
    part: Int[np.ndarray, " waypoint"]
    clearance: Clearance  # of each waypoint
    # Number of waypoints without room for the stand-off: near the tip from inside, in a narrow
    # fold, or at the surface
    left_out: int

    def __len__(self) -> int:
        return len(self.position)

    @property
    def heading(self) -> PerWaypoint:
        """Heading of the camera, clockwise from true north [deg]."""
        return compass(self.facing[:, :2])

    @property
    def pitch(self) -> PerWaypoint:
        """Pitch of the camera, upwards [deg]."""
        return np.rad2deg(np.arcsin(np.clip(self.facing[:, 2], -1.0, 1.0)))


def inspection_path(
    net: PredictedNet,
    *,
    stand_off: float = 2.0,
    side: Side = "inside",
    pattern: Pattern = "rows",
    row_spacing: float = 2.0,
    step: float = 1.0,
    top: float = 1.0,
    below: float = 1.0,
) -> InspectionPath:
    """Plan an inspection path along a net, from its top to its tip.

    It follows the expected net, the predicted one corrected by the twin's mean error, and keeps
    the stand-off to all of it; each waypoint has the probability in its clearance. Rows go round
    and come back, each a little deeper; a spiral goes down as it goes round. The path between
    two waypoints of a part is straight.

    Raises InputError: a size that is not above 0, too many waypoints, or none with room for the
    stand-off.

    Parameters
    ----------
    net
        As predicted.
    stand_off
        Distance to keep [m].
    side
        Of the net.
    pattern
        Rows or a spiral.
    row_spacing
        Between rows, along the net [m].
    step
        Between waypoints, along the net [m].
    top
        Depth of the first row, and of the shallowest waypoint [m].
    below
        Distance of ``p_below`` in the clearance of the waypoints [m].
    """
    for name, size in {"stand_off": stand_off, "row_spacing": row_spacing, "step": step}.items():
        if not (np.isfinite(size) and size > 0.0):
            raise InputError(f"inspection: {name} = {size:g} m must be above 0 m.")
    rings = _rings(net)
    turn, spoke, row = _course(rings, pattern, row_spacing, step, top)
    base, sign = _on_net(rings, turn, spoke), -1.0 if side == "inside" else 1.0
    position = base + sign * stand_off * _nearest(net, base).normal
    for _ in range(_ROUNDS):
        near = _nearest(net, position)
        position = position + sign * (stand_off - _room(near, sign))[:, None] * near.normal
    near = _nearest(net, position)
    keep = (_room(near, sign) > _TOO_NEAR * stand_off) & (position[:, 2] <= -0.5 * top)
    if not keep.any():
        raise InputError(
            f"No waypoint {side} the net keeps {stand_off:g} m off it. Ask for a smaller stand-off."
        )
    position, to_net = position[keep], (near.position - position)[keep]
    leg = np.diff(position, axis=0)
    tight = _room(_nearest(net, position[:-1] + leg / 2.0), sign) < stand_off / 2.0
    broken = tight | (np.linalg.norm(leg, axis=1) > _STRIDES * max(step, row_spacing))
    return InspectionPath(
        position=position,
        facing=to_net / np.linalg.norm(to_net, axis=1, keepdims=True),
        row=row[keep],
        part=np.append(0, np.cumsum(broken)),
        clearance=net.clearance(position, below=below),
        left_out=int(np.sum(~keep)),
    )


def _course(
    rings: RingSpoke3, pattern: Pattern, row_spacing: float, step: float, top: float
) -> tuple[PerWaypoint, PerWaypoint, Int[np.ndarray, " waypoint"]]:
    """Position of each waypoint on the net, in rings down and spokes round, and its row."""
    middle = rings.mean(axis=1)
    down = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(rings, axis=0), axis=2).mean(axis=1)))
    start = float(np.interp(top, -middle[:, 2], down))
    rows = max(2, 1 + round((down[-1] - start) / row_spacing))
    side = np.linalg.norm(rings - np.roll(rings, 1, axis=1), axis=2)
    around: Float[np.ndarray, " ring"] = side.sum(axis=1)
    if rows * around.max() / step > MOST_WAYPOINTS:
        raise InputError(
            f"inspection: {rows} rows with a waypoint every {step:g} m are more than "
            f"{MOST_WAYPOINTS} waypoints. Ask for a longer step or wider rows."
        )
    at = start + (float(down[-1]) - start) * np.arange(rows) / (rows - 1)
    counts = np.maximum(np.ceil(np.interp(at, down, around) / step), 1).astype(int)
    row = np.repeat(np.arange(rows), counts)
    share = (np.arange(len(row)) - (np.cumsum(counts) - counts)[row]) / counts[row]
    if pattern == "spiral":
        deeper = share * (at[1] - at[0])
    else:
        share = np.where(row % 2 == 1, 1.0 - share, share)
        deeper = np.zeros(len(row))
    turn = np.interp(at[row] + deeper, down, np.arange(len(down)))
    return turn, rings.shape[1] * share, row


def _rings(net: PredictedNet) -> RingSpoke3:
    """Every ring's expected nodes, and the tip as a ring of its own."""
    cage, shape = net.cage, net.expected_position
    rings = shape[: cage.bottom_node].reshape(cage.rings, cage.spokes, 3)
    tip = np.broadcast_to(shape[cage.bottom_node], (1, cage.spokes, 3))
    return np.concatenate([rings, tip])


def _on_net(
    rings: RingSpoke3, turn: PerWaypoint, spoke: PerWaypoint
) -> Float[np.ndarray, "waypoint 3"]:
    """Points of the net between its nodes, bilinearly."""
    last_ring, spokes = len(rings) - 1, rings.shape[1]
    upper = np.minimum(turn.astype(int), last_ring - 1)
    left = spoke.astype(int) % spokes
    right = (left + 1) % spokes
    down, over = (turn - upper)[:, None], (spoke - np.floor(spoke))[:, None]
    above = rings[upper, left] * (1.0 - over) + rings[upper, right] * over
    beneath = rings[upper + 1, left] * (1.0 - over) + rings[upper + 1, right] * over
    return above * (1.0 - down) + beneath * down


def _nearest(net: PredictedNet, point: Float[np.ndarray, "point 3"]) -> Nearest:
    """Nearest points of the expected net."""
    return net.cage.nearest(point, net.expected_position)


def _room(near: Nearest, sign: float) -> Float[np.ndarray, " point"]:
    """Distance to the net, negative on the wrong side of it [m]."""
    return -sign * np.where(near.inside, near.distance, -near.distance)
