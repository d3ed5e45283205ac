"""Waves push a ring as a closed form says: the water adds mass across a pipe, none along it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import jv

from seacage.cage import Cage, MooringLines
from seacage.conventions import GRAVITY
from seacage.dynamics._kernel._march import March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._parts._assembly import (
    Assembly,
    Bars,
    Bends,
    Cylinders,
    Floats,
    Ground,
    Panels,
    Springs,
)
from seacage.dynamics._physics._motion import NetLaw, along_pipes, water_push
from seacage.ocean import Waves

ACE = Assembly.of(Cage.named("ace"))
RING = ACE.collar
HEIGHT, DEPTH = 0.002, 1000.0  # so small that what goes with its square is nothing
RADIUS = float(np.linalg.norm(ACE.position[0, :2]))


def wave(period):
    frequency = 2.0 * np.pi / period
    return Waves(
        amplitude=np.array([HEIGHT]),
        angular_frequency=np.array([frequency]),
        wavenumber=np.array([frequency**2 / GRAVITY]),
        phase=np.zeros(1),
        direction=np.array([[1.0, 0.0]]),
        depth=DEPTH,
    )


def closed_form(period, displaced, coefficient):
    """Amplitude of the force in surge, a horizontal ring in long waves [N]."""
    frequency = 2.0 * np.pi / period
    reach = frequency**2 / GRAVITY * RADIUS
    pushed = jv(0, reach) + coefficient * (jv(0, reach) - jv(2, reach)) / 2.0
    return displaced * frequency**2 * HEIGHT * pushed


def bare_ring(inert):
    """The collar's nodes with the water's share alone, each for itself, and so heavy as wanted."""
    slender = ACE.slender.rows(np.isin(ACE.slender.nodes, RING))
    water = 2.0 * slender.added_mass  # the collar's coefficient is 1: as much is displaced
    return replace(
        ACE,
        position=ACE.position[RING],
        weight=np.zeros(len(RING)),
        mass=water + inert,
        water_mass=water,
        slender=slender,
        fixed=ACE.fixed[RING],
        chord=ACE.chord[RING],
        line_bars=np.zeros(0, dtype=np.int64),
        line_floats=np.zeros(0, dtype=np.int64),
        anchor_bars=np.zeros(0, dtype=np.int64),
        net_bars=np.zeros(0, dtype=np.int64),
        bridles=np.zeros(0, dtype=np.int64),
        lines=MooringLines.alike((), "line"),
        bars=Bars.none(),
        bends=Bends.none(),
        panels=Panels.none(),
        cylinders=Cylinders.none(),
        floats=Floats.none(),
        springs=Springs.none(),
        ground=Ground(nodes=np.zeros(0, dtype=np.int64), stiffness=np.zeros(0), level=-DEPTH),
    )


@pytest.mark.parametrize("period", [6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 14.0])
def test_a_ring_in_surge_is_pushed_as_its_closed_form_says(period):
    ring, frequency = bare_ring(0.0), 2.0 * np.pi / period
    phase = frequency**2 / GRAVITY * ring.position[:, 0]
    acceleration = np.zeros((1, len(RING), 3))
    acceleration[0, :, 0] = frequency**2 * HEIGHT * np.cos(phase)
    force = water_push(ring, acceleration).sum(axis=1)[0, 0]
    displaced = float(np.sum(ring.slender.added_mass))
    # 32 nodes round a ring sum a Bessel function to rounding, while the wave is not far shorter
    assert force == pytest.approx(closed_form(period, displaced, 1.0), rel=1e-6)


@pytest.mark.parametrize("period", [6.0, 8.0, 10.0, 14.0])
def test_the_march_pushes_a_ring_in_surge_as_its_closed_form_says(period):
    ring = bare_ring(1e5)
    steps = Steps(
        time_step=0.01,
        each=10,
        hold=1,
        ramp=0.0,
        spin_up=0,
        counted=round(20.0 * period),
        sample_every=1,
    )
    ocean = Ocean(
        waves=(wave(period),), current=np.zeros((1, 1, 2)), level_z=np.zeros(1), depth=DEPTH
    )
    law = NetLaw(name="morison", wake=np.ones((1, 0)))
    march = March(ring, law, ocean, steps, ring.position[None])
    momentum = [0.0]
    for _ in range(steps.counted):
        march.go(1)
        velocity = march.velocity
        whole = ring.mass[:, None] * velocity - along_pipes(ring.slender, velocity)
        momentum.append(whole.sum(axis=1)[0, 0])
    # of the second period: the waves begin at once
    late = slice(round(10.0 * period), None)
    force = (np.diff(momentum) / 0.1)[late]
    time = 0.1 * (np.arange(steps.counted) + 0.5)[late]
    angle = 2.0 * np.pi * time / period
    found = 2.0 * np.hypot(np.mean(force * np.cos(angle)), np.mean(force * np.sin(angle)))
    displaced = float(np.sum(ring.slender.added_mass))
    # 2 %: each node feels the mean of the waves over its chord, 1 % less at 6 s; looks at the
    # water 0.1 s apart
    assert found == pytest.approx(abs(closed_form(period, displaced, 1.0)), rel=0.02)


def test_a_pushed_pipe_is_light_along_itself_and_heavy_across():
    ring = bare_ring(500.0)
    springs = Springs(
        nodes=np.arange(len(RING)),
        stiffness=np.zeros((len(RING), 3)),
        preload=np.tile([100.0, 0.0, 0.0], (len(RING), 1)),
        damping=np.zeros((len(RING), 3)),
    )
    steps = Steps(time_step=0.01, each=10, hold=1, ramp=0.0, spin_up=0, counted=1, sample_every=0)
    flat = replace(wave(8.0), amplitude=np.zeros(1))
    ocean = Ocean(waves=(flat,), current=np.zeros((1, 1, 2)), level_z=np.zeros(1), depth=DEPTH)
    law = NetLaw(name="morison", wake=np.ones((1, 0)))
    march = March(replace(ring, springs=springs), law, ocean, steps, ring.position[None])
    march.go(1)
    across, along = 10.0 / ring.mass, 10.0 / (ring.mass - ring.slender.added_mass)
    tangent = ring.slender.tangent
    east = np.array([1.0, 0.0, 0.0])
    sliding = tangent[:, :1] * tangent
    expected = along[:, None] * sliding + across[:, None] * (east - sliding)
    # a few roundings of single precision, of the largest
    np.testing.assert_allclose(march.velocity[0], expected, atol=1e-6 * along.max())
