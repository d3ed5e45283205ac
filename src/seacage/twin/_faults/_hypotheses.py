"""Hypotheses of the fault detector, each with the shift of the readings that it predicts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.twin._faults._residuals import ResidualBlock
from seacage.twin._settings import FaultDetectorSettings


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Hypothesis:
    """A fault, and the shift of the sensors' readings by it.

    The shift is ``scale`` times an unknown size with a normal prior.
    """

    alarm: str  # raised for it
    variant: str = ""  # distinguishes the hypotheses of one alarm
    scale: Float[np.ndarray, " sensor"]  # of each sensor, zero where it does not respond [N] or [m]
    # Prior mean and standard deviation of the size [-]
    size: Float[np.ndarray, " sensor"]
    sd: Float[np.ndarray, " sensor"]
    walk: float = 0.0  # standard deviation of the size's change from block to block [-]
    lasts: bool = True  # whether an estimate of the size from one block holds in the next

    @property
    def name(self) -> str:
        """Key of its evidence."""
        return f"{self.alarm} {self.variant}".strip()


def hypotheses(
    block: ResidualBlock, cage: Cage, settings: FaultDetectorSettings, *, net_changed: bool = False
) -> Iterator[Hypothesis]:
    """List the hypotheses: of each alarm the one with the widest prior first.

    ``net_changed``: whether people have said that the net was cleaned or changed.
    """
    lines = {
        block.sensors.index(one.name): one.bridle
        for one in cage.shackles
        if one.name in block.sensors
    }
    for row, name in enumerate(block.sensors):
        load = float(block.tension[lines[row]]) if row in lines else None
        yield from _sensor_faults(block, row, f"irregular.{name}", load, settings)
    for bridle, name in enumerate(cage.bridle_names):
        corner = cage.bridle_corner == cage.bridle_corner[bridle]
        if np.count_nonzero(corner[list(lines.values())]) >= 2:
            yield _bridle_fault(block, cage, lines, bridle, f"bridle.{name}", settings)
    # Of a cleaned net: its depths change by more than their gradients say.
    half = "half", block.half_drag, settings.half_loss, settings.half_loss_sd
    hole = "", block.drag, -settings.drag_loss, settings.drag_loss_sd
    for variant, scale, size, sd in [hole] if net_changed else [half, hole]:
        yield Hypothesis(
            alarm="net.net",
            variant=variant,
            scale=scale,
            size=np.full_like(scale, size),
            sd=np.full_like(scale, sd),
            lasts=not variant,
        )


def _sensor_faults(
    block: ResidualBlock, row: int, alarm: str, load: float | None, settings: FaultDetectorSettings
) -> Iterator[Hypothesis]:
    """List the faults of a sensor alone.

    It reads anything, is off by a constant, has begun to drift up or down, or, if it bears a
    load [N], reads nothing.
    """
    here, own = np.eye(len(block.sensors))[row], float(block.own_sd[row])
    drift, sd, walk = settings.drift, settings.drift_sd, settings.drift_walk
    faults = [
        ("", own, 0.0, settings.wide_sd, 0.0),
        ("off", own, 0.0, settings.wide_sd, settings.offset_walk),
        ("more", own, drift, sd, walk),
        ("less", own, -drift, sd, walk),
    ]
    if load is not None:
        faults.append(("nothing", max(load, 0.0), -1.0, settings.own_load_sd, 0.0))
    for variant, scale, size, sd, walk in faults:
        yield Hypothesis(
            alarm=alarm,
            variant=variant,
            scale=scale * here,
            size=size * here,
            sd=sd * here,
            walk=walk,
            lasts=walk > 0.0,
        )


def _bridle_fault(
    block: ResidualBlock,
    cage: Cage,
    lines: Mapping[int, int],
    bridle: int,
    alarm: str,
    settings: FaultDetectorSettings,
) -> Hypothesis:
    """Make the hypothesis that a bridle has parted, and others bear its load.

    ``lines`` has the bridle of each shackle's row.
    """
    rows, line = list(lines), np.array(list(lines.values()))
    scale, size, sd = np.zeros((3, len(block.sensors)))
    scale[rows] = max(float(block.tension[bridle]), 0.0)
    size[rows] = load_shares(cage, bridle, settings)[line]
    corner = cage.bridle_corner[line] == cage.bridle_corner[bridle]
    others = np.where(corner, settings.corner_load_sd, settings.far_load_sd)
    sd[rows] = np.where(line == bridle, settings.own_load_sd, others)
    return Hypothesis(alarm=alarm, scale=scale, size=size, sd=sd, lasts=False)


def load_shares(
    cage: Cage, bridle: int, settings: FaultDetectorSettings
) -> Float[np.ndarray, " line"]:
    """Shares of a parted bridle's load that the other lines of its corner take over [-].

    The corner is pulled back until the remaining lines, and the stiffness that holds it in its
    place, bear the load. Left out: slack lines, the collar's bending, and the other corners,
    which bear a tenth of it. The parted line itself loses all.
    """
    ends = cage.design_position[cage.bridle_nodes]
    along = (ends - cage.corner_position[cage.bridle_corner])[:, :2]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    others = np.flatnonzero(cage.bridle_corner == cage.bridle_corner[bridle])
    others = others[others != bridle]
    stiffness = settings.corner_stiffness * np.eye(2) + along[others].T @ along[others]
    shares = np.zeros(cage.bridle_count)
    shares[others] = along[others] @ np.linalg.solve(stiffness, along[bridle])
    shares[bridle] = -1.0
    return shares
