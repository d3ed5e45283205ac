"""The compiled kernel computes what the readable definition says, for any cage and flow."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks._newton import nearer
from compiled import still_force
from extensions import OWN_LAW
from seacage.cage import Cage
from seacage.dynamics import LAWS
from seacage.dynamics._kernel._library import Balance, Balancing, kernel
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import nodal_force

ACE = Cage.named("ace")
ANCHORED = anchor_assembly(
    ACE.altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 15.0], "cylinder_depth_m": 15.0})
)
"""On buoys and lines, some nodes of which the shaking puts into the sea bed."""


@settings(max_examples=60)
@given(
    rings=st.integers(2, 6),
    spokes=st.integers(3, 12),
    cylinder=st.integers(1, 5),
    anchored=st.booleans(),
    law=st.sampled_from((*LAWS, OWN_LAW)),
    wake=st.booleans(),
    waves=st.booleans(),
    pipe_drag=st.booleans(),
    sheared=st.booleans(),
    shaken=st.floats(0.0, 3.0),
    raised=st.sampled_from([0.0, 4.0, 100.0]),  # out of the water in part or all
    narrowed=st.sampled_from([1.0, 0.1, 0.01]),  # into folds
    cases=st.integers(1, 8),
    seed=st.integers(0, 2**32 - 1),
)
def test_the_kernel_computes_the_definition(
    rings,
    spokes,
    cylinder,
    anchored,
    law,
    wake,
    waves,
    pipe_drag,
    sheared,
    shaken,
    raised,
    narrowed,
    cases,
    seed,
):
    rng = np.random.default_rng(seed)
    cage = some_cage(rng, rings, spokes, cylinder)
    cage = cage.fouled(shallow=rng.uniform(0.0, 0.1), deep=rng.uniform(0.0, 0.1))
    turned = Assembly.of(cage.rotated(rng.uniform(0.0, 360.0)))
    assembly = ANCHORED if anchored else turned
    velocity = rng.uniform(-1.5, 1.5, (cases, 2))
    velocity[0] *= rng.integers(2)  # now and then still water
    variance = rng.uniform(0.0, 0.5, (cases, len(assembly.panels.depth))) if waves else None
    flow = steady_flow(
        assembly,
        velocity,
        law=law,
        wake=wake,
        pipe_drag=pipe_drag,
        wave_variance=variance,
        shear=rng.uniform(-0.8, 0.8, (cases, 2)) if sheared else None,
    )
    position = assembly.position + rng.normal(scale=shaken, size=(cases, *assembly.position.shape))
    position[..., 2] += raised
    position[..., :2] *= narrowed
    defined = nodal_force(assembly, flow, position)
    computed = still_force(assembly, flow, position)
    # the kernel sums in another order: 1e-9 of the largest force in each case
    scale = np.abs(defined).max(axis=(1, 2), keepdims=True)
    assert np.all(np.abs(computed - defined) <= 1e-9 * scale)


def some_cage(rng, rings, spokes, cylinder):
    depths = np.cumsum([0.0, *rng.uniform(1.0, 6.0, rings - 1)]).tolist()
    return ACE.altered(
        mesh={
            "spokes": spokes,
            "ring_depths_m": depths,
            "cylinder_depth_m": depths[min(cylinder, rings - 1)],
            "tip_depth_m": depths[-1] + 4.0,
        }
    )


@settings(max_examples=30)
@given(
    rings=st.integers(2, 5),
    spokes=st.integers(3, 10),
    cylinder=st.integers(1, 4),
    anchored=st.booleans(),
    law=st.sampled_from(LAWS),
    held=st.booleans(),
    shaken=st.floats(0.01, 1.0),  # a bar cut to its length is taut or slack by rounding alone
    raised=st.sampled_from([0.0, 4.0]),
    moved=st.sampled_from([1e-3, 1e3]),
    barrier=st.sampled_from([1e-6, 1.0, 1e4]),
    cases=st.integers(1, 8),
    seed=st.integers(0, 2**32 - 1),
)
def test_the_kernel_takes_the_defined_step_towards_balance(
    rings, spokes, cylinder, anchored, law, held, shaken, raised, moved, barrier, cases, seed
):
    rng = np.random.default_rng(seed)
    cage = some_cage(rng, rings, spokes, cylinder)
    assembly = ANCHORED if anchored else Assembly.of(cage)
    mean, shear = rng.uniform(-1.0, 1.0, (2, cases, 2))
    flow = steady_flow(assembly, mean, law=law, shear=0.5 * shear if held else None)
    position = assembly.position + rng.normal(scale=shaken, size=(cases, *assembly.position.shape))
    position[..., 2] += raised
    tension = rng.uniform(0.1, 1e4, (cases, len(assembly.bars.length)))
    # a shift beyond all that the water can turn: else a chance zero root would part the two
    begun = Balancing.begun(position, tension, barrier=barrier, shift=1e6)
    begun.moved[:] = moved
    free = ~assembly.fixed
    free[assembly.collar] = not held
    balance = Balance(
        free=free, tolerance=1e-3, reach=0.5, least_barrier=1e-7, least_shift=0.1, most_shift=1e7
    )
    computed = kernel().balance(assembly, flow, begun, balance, iterations=1)
    for case in range(cases):
        one = np.array([case])
        defined = nearer(assembly, flow.rows(one), begun.rows(one), balance)
        for name in Balancing.__slots__:
            wanted, found = getattr(defined, name)[0], getattr(computed, name)[case]
            # rounding of forces up to 1e8 N in a matrix of entries up to 1e8 N/m
            np.testing.assert_allclose(
                found, wanted, rtol=1e-6, atol=1e-7 * np.abs(wanted).max(), err_msg=name
            )
