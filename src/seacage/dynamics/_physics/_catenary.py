"""The elastic catenary: a mooring line between two points, with or without sea bed."""

import math
from collections.abc import Callable
from typing import NamedTuple

from seacage.conventions import InputError

# Horizontal tension over the line's weight below which the line hangs plumb [-]
LEAST_SHARE = 1e-20


def catenary(
    x_span: float,
    z_span: float,
    length: float,
    axial_stiffness: float,
    weight: float,
    *,
    seabed_friction: float | None = None,
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Forces that a hanging elastic line puts on its two ends.

    End B lies ``x_span`` beside and ``z_span`` above end A. Bending, drag and a sloping
    sea bed are left out.

    Parameters
    ----------
    x_span, z_span
        From A to B, horizontal (above 0) and vertical (at least 0) [m].
    length
        Unstretched [m].
    axial_stiffness
        EA [N].
    weight
        Submerged, per metre (above 0) [N/m].
    seabed_friction
        Friction coefficient of a flat sea bed at A's height; 0 lets the line slide on it.
        None: there is no sea bed, and the line may hang below A.

    Returns the force on A and that on B (horizontal, vertical), x towards B, z up [N].

    Raises InputError: spans, lengths or properties that no line can have, and a line so long that
    it hangs plumb onto the sea bed.

    Source: Irvine (1981), elastic catenary; Jonkman (2007), sea-bed contact with friction.
    """
    line = _Line(x_span, z_span, length, axial_stiffness, weight, seabed_friction)
    _check(line)
    horizontal, vertical = _solve(line)
    lying = _lying(line, vertical)
    if lying > 0.0:
        held = max(horizontal - (line.friction or 0.0) * weight * lying, 0.0)
        force_a = (held, 0.0)
    else:
        force_a = (horizontal, vertical - weight * length)
    return force_a, (-horizontal, -vertical)


class _Line(NamedTuple):
    """Arguments of ``catenary``."""

    x_span: float
    z_span: float
    length: float
    stiffness: float
    weight: float
    friction: float | None


def _solve(line: _Line) -> tuple[float, float]:
    """Horizontal and vertical tension at B [N].

    B comes to lie the higher the more is pulled up, and the further off the more is pulled
    sideways with its height kept. So one root inside another always finds the one answer,
    for slack and for taut lines.
    """
    from scipy.optimize import root_scalar

    def root_of(miss: Callable[[float], float], low: float, high: float) -> float:
        return float(root_scalar(miss, bracket=(low, high), xtol=1e-15).root)

    def vertical(horizontal: float) -> float:
        low = line.weight * line.length / 2.0 if line.friction is None else 0.0
        high = line.stiffness * line.z_span / line.length + line.weight * line.length
        return root_of(lambda v: _up(line, horizontal, v) - line.z_span, low, high)

    def miss(log_horizontal: float) -> float:
        horizontal = math.exp(log_horizontal)
        return _across(line, horizontal, vertical(horizontal)) - line.x_span

    hung = math.log(line.weight * line.length)
    least, low = hung + math.log(LEAST_SHARE), hung
    while miss(low) > 0.0:
        low -= 3.0
        if low < least:
            raise InputError(
                f"catenary: {line.length:g} m of line across {line.x_span:g} m and up "
                f"{line.z_span:g} m hangs plumb and lies loose on the sea bed, without "
                "horizontal tension. Shorten the line."
            )
    most = line.stiffness * line.x_span / line.length
    most += (line.friction or 0.0) * line.weight * line.length
    horizontal = math.exp(root_of(miss, low, max(math.log(most), low) + 1.0))
    return horizontal, vertical(horizontal)


def _across(line: _Line, horizontal: float, vertical: float) -> float:
    """Horizontal distance of B from A under given tensions there [m]."""
    h, weight, stiffness = horizontal, line.weight, line.stiffness
    stretch = h * line.length / stiffness
    lying = _lying(line, vertical)
    if lying > 0.0:
        if line.friction:
            loose = lying - h / (line.friction * weight)
            given = -(lying**2) + loose * max(loose, 0.0)
            stretch += line.friction * weight / (2.0 * stiffness) * given
        return lying + h / weight * math.asinh(vertical / h) + stretch
    foot = vertical - weight * line.length
    if foot < 0.0:
        return h / weight * (math.asinh(vertical / h) - math.asinh(foot / h)) + stretch
    # the difference of two nearly equal asinh, without its cancellation
    share = weight * line.length / (math.hypot(h, vertical) + math.hypot(h, foot))
    return 2.0 * h / weight * math.atanh(share) + stretch


def _up(line: _Line, horizontal: float, vertical: float) -> float:
    """Height of B above A under given tensions there [m]."""
    h, v, weight, stiffness = horizontal, vertical, line.weight, line.stiffness
    if _lying(line, v) > 0.0:
        return v**2 / weight * (1.0 / (h + math.hypot(h, v)) + 0.5 / stiffness)
    foot = v - weight * line.length
    mean_tension = (math.hypot(h, v) + math.hypot(h, foot)) / 2.0
    return (v + foot) / 2.0 * line.length * (1.0 / mean_tension + 1.0 / stiffness)


def _lying(line: _Line, vertical: float) -> float:
    """Length of line on the sea bed [m]."""
    return 0.0 if line.friction is None else max(line.length - vertical / line.weight, 0.0)


def _check(line: _Line) -> None:
    names = ("x_span (m)", "length (m)", "axial_stiffness (N)", "weight (N/m)")
    above = (line.x_span, line.length, line.stiffness, line.weight)
    for name, value in zip(names, above, strict=True):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"catenary: {name} = {value:g} must be above 0 and finite.")
    if not (math.isfinite(line.z_span) and line.z_span >= 0.0):
        raise InputError(
            f"catenary: z_span = {line.z_span:g} m must be at least 0. Take the lower end as end A."
        )
    if line.friction is not None and not (math.isfinite(line.friction) and line.friction >= 0.0):
        raise InputError(f"catenary: seabed_friction = {line.friction:g} must be at least 0.")
