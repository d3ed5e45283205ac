"""Chains of bars against the closed forms of a hanging line, brought to rest in both ways."""

from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import MooringLines
from seacage.conventions import GRAVITY
from seacage.dynamics import catenary
from seacage.dynamics._kernel._library import Balance, Balancing, Relaxation, Relaxing, kernel
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Cylinders,
    Floats,
    Ground,
    Panels,
    Scales,
    Slender,
    Springs,
)
from seacage.dynamics._physics._loads import SteadyFlow, bar_tension, nodal_force

NONE = np.zeros(0)
NO_INDEX = np.zeros(0, dtype=np.int64)
STILL = SteadyFlow(
    direction=np.zeros((1, 3)),
    **{name: np.zeros((1, 0)) for name in ("pressure", "constant", "slope", "third")},
    **{name: np.zeros((1, 0)) for name in ("lift", "lift_second")},
    pipe_pressure=np.zeros((1, 1)),
)


def chain(position, *, length, axial_stiffness, weight):
    """A line alone in the sea: equal bars, half of each one's weight on either end."""
    count = len(position) - 1
    nodal = np.full(count + 1, -weight * length / count)
    nodal[[0, -1]] /= 2.0
    return Assembly(
        cage_nodes=count + 1,
        scales=Scales(length=1.0, mesh=1.0, force=1.0),
        collar=NO_INDEX,
        position=position,
        weight=nodal,
        mass=-nodal / GRAVITY,
        water_mass=np.zeros(count + 1),
        slender=Slender.none(),
        fixed=np.zeros(count + 1, dtype=bool),
        chord=np.zeros((count + 1, 2)),
        bars=Bars(
            ends=np.stack([np.arange(count), np.arange(count) + 1], axis=1),
            length=np.full(count, length / count),
            stiffness=np.full(count, axial_stiffness),
            pushed=np.zeros(count, dtype=bool),
            damping_ratio=np.zeros(count),
        ),
        bridles=NO_INDEX,
        lines=MooringLines.alike((), "line"),
        line_bars=NO_INDEX,
        line_floats=NO_INDEX,
        anchor_bars=NO_INDEX,
        net_bars=NO_INDEX,
        bends=Bends.none(),
        panels=Panels(
            corners=np.zeros((0, 4), dtype=np.int64),
            share=np.zeros((0, 4)),
            solidity=NONE,
            twine_diameter=NONE,
            outward=np.zeros((0, 2)),
            half_width=NONE,
            depth=NONE,
            area=NONE,
            outline=NONE,
            twine_spacing=NONE,
            diamond=np.zeros(0, dtype=bool),
        ),
        cylinders=Cylinders(
            ends=np.zeros((0, 2), dtype=np.int64), drag_width=NONE, skin_width=NONE, body=NO_INDEX
        ),
        floats=Floats(nodes=NO_INDEX, stiffness=NONE, draft=NONE, height=NONE),
        springs=Springs(
            nodes=NO_INDEX,
            stiffness=np.zeros((0, 3)),
            preload=np.zeros((0, 3)),
            damping=np.zeros((0, 3)),
        ),
        ground=Ground(nodes=NO_INDEX, stiffness=NONE, level=-1e3),
    )


def relaxed(line, *, held, tolerance):
    rate = line.bars.stiffness / line.bars.length
    inverse_mass = np.full(len(line.position), 1.0 / (0.6 * 2.0 * rate[0]))
    inverse_mass[held] = 0.0
    relaxation = Relaxation(
        inverse_mass=inverse_mass,
        soft_rate=rate,
        tolerance=tolerance,
        progress=0.9,
        patience=6,
        most_damping=0.15,
        steps=300,
    )
    state = Relaxing.begun(line.position[None].copy(), len(rate), np.array([0.01]))
    return kernel().relax(line, STILL, state, relaxation, rounds=200)


def balanced(line, *, held, tolerance):
    free = np.ones(len(line.position), dtype=bool)
    free[held] = False
    balance = Balance(
        free=free,
        tolerance=tolerance,
        reach=5.0,
        least_barrier=1e-9,
        least_shift=1e-6,
        most_shift=1e4,
    )
    borne = np.full((1, len(line.bars.length)), 1000.0)
    state = Balancing.begun(line.position[None].copy(), borne, barrier=1.0, shift=1.0)
    return kernel().balance(line, STILL, state, balance, iterations=100)


@pytest.fixture(params=[relaxed, balanced])
def settled(request):
    """Either way to rest; it gives the nodes' places."""

    def run(line, *, held, tolerance):
        state = request.param(line, held=held, tolerance=tolerance)
        assert state.residual[0] <= tolerance
        return state.position

    return run


def test_a_lone_hanging_chain_stretches_link_by_link_under_what_hangs_below(settled):
    links, length, stiffness, weight, hung = 20, 30.0, 1e5, 120.0, 900.0
    straight = np.zeros((links + 1, 3))
    straight[:, 2] = -np.linspace(0.0, length, links + 1)
    line = chain(straight, length=length, axial_stiffness=stiffness, weight=weight)
    load = line.weight.copy()
    load[-1] -= hung
    line = replace(line, weight=load)
    position = settled(line, held=[0], tolerance=1e-6)
    below = hung + weight * length * (1.0 - (np.arange(links) + 0.5) / links)
    np.testing.assert_allclose(bar_tension(line.bars, position)[0], below, rtol=1e-7)
    stretch = hung * length / stiffness + weight * length**2 / (2.0 * stiffness)
    assert -position[0, -1, 2] == pytest.approx(length + stretch, rel=1e-9)


@pytest.mark.parametrize(("x", "z", "length"), [(40.0, 0.0, 46.0), (40.0, 25.0, 52.0)])
def test_a_chain_between_two_points_pulls_on_them_as_the_catenary_does(settled, x, z, length):
    links, stiffness, weight = 60, 2e5, 150.0
    straight = np.linspace([0.0, 0.0, 0.0], [x, 0.0, z], links + 1)
    line = chain(straight, length=length, axial_stiffness=stiffness, weight=weight)
    position = settled(line, held=[0, -1], tolerance=0.01)
    on_ends = nodal_force(line, STILL, position)[0, [0, -1]][:, [0, 2]]
    expected = catenary(x, z, length, stiffness, weight)
    # a polygon of 60 sides: its error falls as the square of their number
    np.testing.assert_allclose(on_ends, expected, rtol=2e-3, atol=2.0)


def test_a_finer_chain_comes_closer_to_the_catenary(settled):
    (expected, _), _ = catenary(40.0, 0.0, 46.0, 2e5, 150.0)
    errors = []
    for links in (10, 20, 40):
        straight = np.linspace([0.0, 0.0, 0.0], [40.0, 0.0, 0.0], links + 1)
        line = chain(straight, length=46.0, axial_stiffness=2e5, weight=150.0)
        position = settled(line, held=[0, -1], tolerance=1e-3)
        errors.append(abs(nodal_force(line, STILL, position)[0, 0, 0] - expected))
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2]
