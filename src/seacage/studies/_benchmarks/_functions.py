"""The functions of the benchmark problems, each fidelity from low to high.

All take one row of inputs per case, in the units of the source, and answer with (row,).
"""

from functools import partial

import numpy as np
from jaxtyping import Float

Rows = Float[np.ndarray, "row feature"]
Answers = Float[np.ndarray, " row"]
_HARTMANN_WIDTH = np.array([[3.0, 10.0, 30.0], [0.1, 10.0, 35.0]] * 2)
_HARTMANN_CENTRE = 1e-4 * np.array(
    [[3689, 1170, 2673], [4699, 4387, 7470], [1091, 8732, 5547], [381, 5743, 8828]]
)
_HARTMANN_DEPTH = np.array([1.0, 1.2, 3.0, 3.2])
# What one step down in fidelity adds to each depth
_HARTMANN_STEP = np.array([0.01, -0.01, -0.1, 0.1])


def pedagogical_low(x: Rows) -> Answers:
    """Four waves on the unit interval; Perdikaris et al. (2017), section 3(a)."""
    return np.sin(8.0 * np.pi * x[:, 0])


def pedagogical_high(x: Rows) -> Answers:
    """A nonlinear transform of the low fidelity that changes along x."""
    return (x[:, 0] - np.sqrt(2.0)) * pedagogical_low(x) ** 2


def branin_high(x: Rows) -> Answers:
    """Branin's function; on x1 from -5 to 10 and x2 from 0 to 15."""
    one, two = x.T
    valley = two - 5.1 / (4.0 * np.pi**2) * one**2 + 5.0 / np.pi * one - 6.0
    return valley**2 + 10.0 * (1.0 - 1.0 / (8.0 * np.pi)) * np.cos(one) + 10.0


def branin_middle(x: Rows) -> Answers:
    """Its root, shifted and tilted; Perdikaris et al. (2017), section 3(b)."""
    one, two = x.T
    root = np.sqrt(branin_high(x - 2.0))
    return 10.0 * root + 2.0 * (one - 0.5) - 3.0 * (3.0 * two - 1.0) - 1.0


def branin_low(x: Rows) -> Answers:
    """The middle fidelity, shifted, stretched and tilted."""
    return branin_middle(1.2 * (x + 2.0)) - 3.0 * x[:, 1] + 1.0


def currin_high(x: Rows) -> Answers:
    """Currin et al. (1988), on the unit square; at x2 = 0 its limit."""
    one, two = x.T
    above = two > 0.0
    fade = np.exp(-0.5 / np.where(above, two, 1.0)) * above
    rise = 2300.0 * one**3 + 1900.0 * one**2 + 2092.0 * one + 60.0
    return (1.0 - fade) * rise / (100.0 * one**3 + 500.0 * one**2 + 4.0 * one + 20.0)


def currin_low(x: Rows) -> Answers:
    """Mean over four neighbours 0.05 away; Xiong, Qian & Wu (2013)."""
    right, up = np.array([0.05, 0.0]), np.array([0.0, 0.05])
    down = np.column_stack([x[:, 0], np.maximum(x[:, 1] - 0.05, 0.0)])
    corners = (x + right + up, x - right + up, down + right, down - right)
    return sum((currin_high(corner) for corner in corners), np.zeros(len(x))) / 4.0


def park_high(x: Rows) -> Answers:
    """Park (1991), first function, on the unit cube; written so that x1 = 0 divides nothing."""
    one, two, three, four = x.T
    root = np.sqrt(one**2 + (two + three**2) * four)
    return 0.5 * (root - one) + (one + 3.0 * four) * np.exp(1.0 + np.sin(three))


def park_low(x: Rows) -> Answers:
    """Swelled by up to a tenth and bent; Xiong, Qian & Wu (2013)."""
    one, two, three, _ = x.T
    return (1.0 + 0.1 * np.sin(one)) * park_high(x) - 2.0 * one + two**2 + three**2 + 0.5


def _borehole(x: Rows, *, head: float, offset: float) -> Answers:
    """Flow of water through a borehole [m3/a]; Morris, Mitchell & Ylvisaker (1993)."""
    radius, influence, upper, upper_head, lower, lower_head, length, conductivity = x.T
    reach = np.log(influence / radius)
    leak = 2.0 * length * upper / (reach * radius**2 * conductivity)
    return head * upper * (upper_head - lower_head) / (reach * (offset + leak + upper / lower))


borehole_high = partial(_borehole, head=2.0 * np.pi, offset=1.0)
# Two constants changed; Xiong, Qian & Wu (2013)
borehole_low = partial(_borehole, head=5.0, offset=1.5)


def _hartmann(x: Rows, *, steps: int) -> Answers:
    """Hartmann's function with four pits, on the unit cube."""
    away = (x[:, None, :] - _HARTMANN_CENTRE) ** 2
    pits = np.exp(-np.sum(_HARTMANN_WIDTH * away, axis=2))
    return -pits @ (_HARTMANN_DEPTH + steps * _HARTMANN_STEP)


# Below the highest fidelity pits of other depths; Cutajar et al. (2019)
hartmann_high, hartmann_middle, hartmann_low = (partial(_hartmann, steps=n) for n in range(3))


def franke_low(x: Rows) -> Answers:
    """Franke's two hills, slope and dip (1979), on the unit square."""
    one, two = 9.0 * x.T
    hill = 0.75 * np.exp(-((one - 2.0) ** 2 + (two - 2.0) ** 2) / 4.0)
    slope = 0.75 * np.exp(-((one + 1.0) ** 2) / 49.0 - (two + 1.0) / 10.0)
    second_hill = 0.5 * np.exp(-((one - 7.0) ** 2 + (two - 3.0) ** 2) / 4.0)
    return hill + slope + second_hill - 0.2 * np.exp(-((one - 4.0) ** 2) - (two - 7.0) ** 2)


def franke_middle(x: Rows) -> Answers:
    """A fading wave of the low fidelity; Heo & Sung (2025)."""
    low = franke_low(x)
    return np.exp(-1.4 * low) * np.cos(3.5 * np.pi * low)


def franke_high(x: Rows) -> Answers:
    """A wave of the middle fidelity."""
    return np.sin(2.0 * np.pi * (franke_middle(x) - 1.0))


def cage_low(x: Rows) -> Answers:
    """Tension of a bridle [kN] in a current (east, north) [m/s]: a formula like a simulator's.

    Drag grows with the square of the current until the net yields; the bridle carries most of it
    when the current goes where the bridle holds against.
    """
    drag, towards = _drag(x, yields_at=1.1)
    return 6.0 + drag * (0.5 + 0.45 * towards)


def cage_high(x: Rows) -> Answers:
    """The same bridle of a net that yields sooner, goes slack in the lee and stands in a wake."""
    drag, towards = _drag(x, yields_at=0.8)
    taut = 3.0 + 1.3 * drag * (0.4 + 0.6 * towards)
    wake = 0.35 * np.exp(-(((x[:, 0] - 0.1) ** 2 + (x[:, 1] - 0.7) ** 2) / 0.12))
    return 2.0 * np.logaddexp(0.0, 0.5 * taut) * (1.0 - wake)


def _drag(x: Rows, *, yields_at: float) -> tuple[Answers, Answers]:
    """Drag [kN], and the cosine between the current and the bridle's side (30° from east)."""
    speed = np.linalg.norm(x, axis=1)
    side = x @ np.array([np.cos(np.pi / 6.0), np.sin(np.pi / 6.0)])
    # Softened at slack water, where a direction means nothing, so that the formula is smooth.
    return 60.0 * speed**2 / (1.0 + (speed / yields_at) ** 2), side / np.sqrt(speed**2 + 0.05**2)
