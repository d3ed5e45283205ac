"""The elastic catenary: a mooring line between two points, with or without sea bed."""

import math

import numpy as np
from jaxtyping import Float

from seacage.conventions import InputError, SeacageError

SLACK_SHARE = 1e-9
"""Least horizontal tension sought, over the line's weight: below it the line hangs plumb."""


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

    Returns
    -------
    force_a, force_b
        On each end (horizontal, vertical), x towards B, z up [N].

    Raises
    ------
    InputError
        Spans, lengths or properties that no line can have.

    References
    ----------
    Irvine (1981), elastic catenary; Jonkman (2007), sea-bed contact with friction.
    """
    _check(x_span, z_span, length, axial_stiffness, weight, seabed_friction)
    line = (x_span, z_span, length, axial_stiffness, weight, seabed_friction)
    horizontal, vertical = _solved(line)
    lying = _lying(vertical, length, weight, seabed_friction)
    if lying > 0.0:
        held = max(horizontal - (seabed_friction or 0.0) * weight * lying, 0.0)
        force_a = (held, 0.0)
    else:
        force_a = (horizontal, vertical - weight * length)
    return force_a, (-horizontal, -vertical)


_Line = tuple[float, float, float, float, float, float | None]


def _solved(line: _Line) -> tuple[float, float]:
    """Horizontal and vertical tension at B [N]."""
    from scipy.optimize import root

    x, z, length, _, weight, _ = line
    scale = weight * length

    def miss(unknown: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        reached = _reach(math.exp(unknown[0]) * scale, unknown[1] * scale, line)
        return (np.array(reached) - (x, z)) / length

    for start in _starts(x, z, length):
        found = root(miss, start, method="hybr", tol=1e-13)
        if np.max(np.abs(found.fun)) < 1e-9:
            return math.exp(found.x[0]) * scale, float(found.x[1]) * scale
    raise SeacageError(
        f"catenary: no equilibrium found for a line of {length:g} m across {x:g} m and up {z:g} m. "
        "Check the units of its weight and stiffness."
    )


def _reach(horizontal: float, vertical: float, line: _Line) -> tuple[float, float]:
    """Where B comes to lie, seen from A, under given tensions there [m]."""
    _, _, length, stiffness, weight, friction = line
    h, v = horizontal, vertical
    top = v / h
    lying = _lying(v, length, weight, friction)
    if lying > 0.0:
        x = lying + h / weight * math.asinh(top) + h * length / stiffness
        if friction:
            loose = lying - h / (friction * weight)
            given = -(lying**2) + loose * max(loose, 0.0)
            x += friction * weight / (2.0 * stiffness) * given
        z = h / weight * (math.hypot(1.0, top) - 1.0) + v**2 / (2.0 * stiffness * weight)
        return x, z
    foot = (v - weight * length) / h
    x = h / weight * (math.asinh(top) - math.asinh(foot)) + h * length / stiffness
    z = h / weight * (math.hypot(1.0, top) - math.hypot(1.0, foot))
    return x, z + (v * length - weight * length**2 / 2.0) / stiffness


def _lying(vertical: float, length: float, weight: float, friction: float | None) -> float:
    """Length of line on the sea bed [m]."""
    return 0.0 if friction is None else max(length - vertical / weight, 0.0)


def _starts(x: float, z: float, length: float) -> list[tuple[float, float]]:
    """First guesses of (log H, V), both over the line's weight: Jonkman's, then wider ones."""
    slack = (length**2 - z**2) / x**2 - 1.0
    sag = math.sqrt(3.0 * slack) if slack > 0.0 else 0.2
    horizontal = max(x / (2.0 * sag * length), SLACK_SHARE)
    vertical = 0.5 * (z / math.tanh(sag) + length) / length
    guess = (math.log(horizontal), vertical)
    return [guess] + [(guess[0] + shift, v) for shift in (-3.0, 3.0, 6.0) for v in (vertical, 0.6)]


def _check(
    x: float, z: float, length: float, stiffness: float, weight: float, friction: float | None
) -> None:
    above = {"x_span (m)": x, "length (m)": length, "axial_stiffness (N)": stiffness}
    above["weight (N/m)"] = weight
    for name, value in above.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"catenary: {name} = {value:g} must be above 0 and finite.")
    if not (math.isfinite(z) and z >= 0.0):
        raise InputError(
            f"catenary: z_span = {z:g} m must be at least 0. Take the lower end as end A."
        )
    if friction is not None and not (math.isfinite(friction) and friction >= 0.0):
        raise InputError(f"catenary: seabed_friction = {friction:g} must be at least 0.")
    if friction is not None and length >= x + z:
        raise InputError(
            f"catenary: {length:g} m of line is at least x_span + z_span = {x + z:g} m: it hangs "
            "plumb and lies loose on the sea bed, without horizontal tension."
        )
