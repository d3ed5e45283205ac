"""Random inputs for every entry of the compiled kernel: valid indices, and any numbers at all."""

import ctypes
from functools import lru_cache
from typing import Any

import numpy as np

from seacage.dynamics._kernel import _structs as c
from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._kernel._march_inputs import WAVE_KINDS
from seacage.dynamics._kernel._sparsity import Pattern, _pattern
from seacage.dynamics._kernel._structs import by_name, pointer

GRAPHS = 200
"""So many structures, each met with many numbers: to plan an elimination takes long."""

WILD = (np.nan, np.inf, -np.inf, 0.0, -0.0, 1e38, -1e38, 1e-38, 1e-45, 1e300, -1e300, 2.0**31)


def numbers(rng: np.random.Generator, *shape: int, kind: Any = np.float32) -> np.ndarray:
    """Of ordinary size, now and then with some or many that no cage should see."""
    plain = rng.normal(size=shape) * 10.0 ** rng.uniform(-3.0, 4.0)
    share = rng.choice([0.0, 0.0, 0.02, 0.5])
    return np.where(rng.random(shape) < share, rng.choice(WILD, shape), plain).astype(kind)


def indices(rng: np.random.Generator, nodes: int, count: int, ends: int) -> np.ndarray:
    """Of nodes, repeated ones among them."""
    return rng.integers(0, nodes, (count, ends), dtype=np.int32)


def march(library: ctypes.CDLL, rng: np.random.Generator) -> None:
    """Some steps through time, then the two entries that the tests use."""
    lanes = int(library.seacage_march_lanes())
    nodes = int(rng.integers(1, 7))
    body, parts = a_body(rng, nodes)
    net = a_netting(rng, parts["panels"], lanes)
    sea = a_sea(rng, lanes)
    refreshes, every = int(rng.integers(0, 4)), int(rng.integers(0, 3))
    schedule = c.ScheduleStruct.filled(
        time_step=float(rng.choice([0.002, 0.1, 0.0, 1e30, np.nan])),
        ramp=float(rng.choice([0.0, 0.1, 60.0])),
        first=0,
        refreshes=refreshes,
        count_from=int(rng.integers(0, 2)),
        sample_every=every,
        steps=int(rng.integers(0, 6)),
        hold=int(rng.integers(1, 5)),
    )
    state = a_state(rng, nodes, parts, lanes)
    record = a_record(nodes, parts, lanes, refreshes if every else 0)
    library.seacage_march(*map(ctypes.byref, (body, net, sea, schedule, state, record)))
    total, at = np.zeros((15, lanes), np.float32), numbers(rng, 3, lanes)  # of five bodies
    library.seacage_march_forces(*map(ctypes.byref, (body, net, state)), pointer(total))
    library.seacage_march_water(
        ctypes.byref(sea),
        pointer(at),
        pointer(numbers(rng, 2)),
        ctypes.c_int32(int(rng.integers(0, 2))),
        ctypes.c_double(float(numbers(rng, kind=np.float64))),
        pointer(np.zeros(lanes, np.float32)),
        pointer(total),
    )


def a_body(rng: np.random.Generator, nodes: int) -> tuple[Any, dict[str, int]]:
    """A structure that no one would build."""
    named = ("bars", "bends", "panels", "cylinders", "springs", "grounds", "slenders")
    parts = {name: int(rng.integers(0, 5)) for name in named}
    floats = np.flatnonzero(rng.random(nodes) < 0.5).astype(np.int32)
    lines = rng.integers(0, max(1, parts["bars"]), int(rng.integers(0, 4)), dtype=np.int32)
    lines = lines[: 4 if parts["bars"] else 0]
    twines = rng.integers(0, max(1, parts["bars"]), 3 if parts["bars"] else 0, dtype=np.int32)
    buoys = rng.integers(0, max(1, len(floats)), 2 if len(floats) else 0, dtype=np.int32)
    parts |= {"floats": len(floats), "buoys": len(buoys), "twines": len(twines)}
    parts["lines"] = len(lines) + len(buoys)
    shapes = {
        **dict.fromkeys(("weight", "mass", "water_mass"), (nodes,)),
        "place": (nodes, 3),
        "chord": (nodes, 2),
        "slender_tangent": (parts["slenders"], 3),
        "slender_mass": (parts["slenders"],),
        **dict.fromkeys(("bar_length", "bar_rate", "bar_damping"), (parts["bars"],)),
        **dict.fromkeys(("bend_stiffness", "bend_plane", "bend_turn"), (parts["bends"],)),
        "panel_share": (parts["panels"], 4),
        **dict.fromkeys(("panel_outline", "panel_mass"), (parts["panels"],)),
        **dict.fromkeys(("cylinder_drag", "cylinder_skin"), (parts["cylinders"],)),
        **dict.fromkeys(("float_stiffness", "float_draft", "float_height"), (len(floats),)),
        **dict.fromkeys(("spring_place", "spring_stiffness"), (parts["springs"], 3)),
        **dict.fromkeys(("spring_preload", "spring_damping"), (parts["springs"], 3)),
        "ground_stiffness": (parts["grounds"],),
        "cylinder_series": (8,),
    }
    body = c.BodyStruct.filled(
        nodes=nodes,
        bar_ends=indices(rng, nodes, parts["bars"], 2),
        bend_nodes=indices(rng, nodes, parts["bends"], 3),
        panel_corners=indices(rng, nodes, parts["panels"], 4),
        cylinder_ends=indices(rng, nodes, parts["cylinders"], 2),
        spring_nodes=indices(rng, nodes, parts["springs"], 1),
        ground_nodes=indices(rng, nodes, parts["grounds"], 1),
        slender_nodes=indices(rng, nodes, parts["slenders"], 1),
        float_nodes=floats,
        line_bars=lines,
        line_floats=buoys,
        anchor_bars=np.append(
            np.where(rng.random(len(lines)) < 0.5, -1, lines), 0 * buoys - 1
        ).astype(np.int32),
        twine_bars=twines,
        cylinder_body=rng.integers(0, 5, parts["cylinders"], dtype=np.int32),
        cage_nodes=int(rng.integers(0, nodes + 1)),
        bar_least=rng.choice([0.0, -np.inf], parts["bars"]).astype(np.float32),
        ground_level=float(numbers(rng)),
        **parts,
        **{name: numbers(rng, *shape) for name, shape in shapes.items()},
    )
    return body, parts


def a_netting(rng: np.random.Generator, panels: int, lanes: int) -> Any:
    """Under any law, and any growth."""
    return c.NettingStruct.filled(
        kind=int(rng.integers(0, 2)),
        law=numbers(rng, panels, 3, lanes),
        drag_factor=numbers(rng, panels, lanes),
        wake=numbers(rng, panels, lanes),
        all=numbers(rng, 6, lanes),
    )


def a_sea(rng: np.random.Generator, lanes: int) -> Any:
    """Waves and currents of any size."""
    components, levels = int(rng.integers(0, 5)), int(rng.integers(1, 4))
    return c.SeaStruct.filled(
        components=components,
        levels=levels,
        spread=int(rng.integers(0, 2)),
        shallow=rng.integers(0, 2, components, dtype=np.int32),
        depth=float(numbers(rng)),
        level_z=numbers(rng, levels),
        current=numbers(rng, levels, 2, lanes),
        **{name: numbers(rng, components + 1, lanes, kind=k) for name, k in WAVE_KINDS.items()},
    )


def a_state(rng: np.random.Generator, nodes: int, parts: dict[str, int], lanes: int) -> Any:
    """Anywhere, at any speed."""
    shapes = {
        **dict.fromkeys((name for name, _ in c.StateStruct._fields_), (nodes, 3)),
        "drag": (nodes,),
        **dict.fromkeys(("elevation", "rise"), (nodes,)),
        "panel_current": (parts["panels"], 3),
        **dict.fromkeys(("panel_factor", "panel_drag", "panel_lift"), (parts["panels"],)),
        "lost_at": (),
    }
    return c.StateStruct.filled(**{n: numbers(rng, *shape, lanes) for n, shape in shapes.items()})


def a_record(nodes: int, parts: dict[str, int], lanes: int, samples: int) -> Any:
    """Room for what a march keeps, and not a number more."""
    sizes = {"node": 3 * nodes, "line": parts["lines"], "load": 15}
    kinds = {"sum": np.float64, "square": np.float64, "least": np.float32, "most": np.float32}
    account = {
        f"{what}_{how}": np.zeros((size, lanes), kind)
        for what, size in sizes.items()
        for how, kind in kinds.items()
    }
    shapes = {
        "positions": (nodes, 3),
        "tensions": (parts["lines"],),
        "elevations": (),
        "loads": (3,),
    }
    return c.RecordStruct.filled(
        **account,
        twine_sum=np.zeros((parts["twines"], lanes)),
        twine_most=np.zeros((parts["twines"], lanes), np.float32),
        twine_slack=np.zeros((parts["twines"], lanes), np.float32),
        anchor_sum=np.zeros((3 * parts["lines"], lanes)),
        uplift_most=np.zeros((parts["lines"], lanes), np.float32),
        counted=np.zeros(1, np.int64),
        sampled=np.zeros(1, np.int64),
        **{n: np.zeros((samples, *shape, lanes), np.float32) for n, shape in shapes.items()},
    )


PARTS = {
    "bars": 2,
    "bends": 3,
    "panels": 4,
    "cylinders": 2,
    "floats": 1,
    "springs": 1,
    "grounds": 1,
}
"""Nodes of each."""

NODES = {
    "bars": "bar_ends",
    "bends": "bend_nodes",
    "panels": "panel_corners",
    "cylinders": "cylinder_ends",
    "floats": "float_nodes",
    "springs": "spring_nodes",
    "grounds": "ground_nodes",
}
"""C's names of them."""


@lru_cache(maxsize=GRAPHS)
def a_graph(seed: int) -> tuple[int, dict[str, np.ndarray], Pattern]:
    """Nodes, the nodes of each part, and the places of its tangent."""
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(1, 9))
    graph = {n: indices(rng, nodes, int(rng.integers(0, 6)), ends) for n, ends in PARTS.items()}
    pattern = _pattern(
        nodes, tuple(PARTS.values()), tuple(part.tobytes() for part in graph.values())
    )
    return nodes, graph, pattern


def settle(library: ctypes.CDLL, rng: np.random.Generator) -> None:
    """Some rounds of the way to rest, and some of Newton's method."""
    lanes = int(library.seacage_lanes())
    nodes, graph, pattern = a_graph(int(rng.integers(GRAPHS)))
    structure = a_structure(rng, nodes, graph)
    panels, bars, pipes = (len(graph[part]) for part in ("panels", "bars", "cylinders"))
    flow = c.FlowStruct.filled(
        direction=doubles(rng, panels, 3, lanes),
        panel=doubles(rng, panels, 6, lanes),
        pipe_direction=doubles(rng, pipes, 3, lanes),
        pipe_pressure=doubles(rng, pipes, lanes),
    )
    patience, steps, rounds = (int(n) for n in rng.integers((1, 0, 0), (3, 4, 4)))
    relaxation = c.RelaxationStruct.filled(
        inverse_mass=doubles(rng, nodes),
        soft_rate=doubles(rng, bars),
        true_rate=doubles(rng, bars),
        tolerance=0.5,
        progress=0.8,
        most_damping=0.9,
        patience=patience,
        steps=steps,
        rounds=rounds,
    )
    shapes = dict.fromkeys(("position", "velocity"), (nodes, 3))
    shapes |= dict.fromkeys(("carried", "tension"), (bars,))
    relaxing = a_case(rng, c.RelaxingStruct, shapes, lanes)
    library.seacage_relax(
        *map(ctypes.byref, (structure, flow, relaxation, relaxing)),
        *(pointer(room) for room in (np.empty((bars, lanes)), np.empty((nodes, 3, lanes)))),
    )
    balance = c.BalanceStruct.filled(
        free=rng.choice([0.0, 1.0], nodes),
        true_rate=doubles(rng, bars),
        tolerance=0.5,
        reach=1.0,
        least_barrier=1e-6,
        least_shift=1e-3,
        most_shift=1e6,
        iterations=int(rng.integers(0, 4)),
    )
    balancing = a_case(rng, c.BalancingStruct, shapes, lanes)
    plan = c.PatternStruct.filled(**by_name(pattern))
    bench = kernel().bench(nodes, bars, pattern)
    library.seacage_balance(*map(ctypes.byref, (structure, flow, plan, balance, balancing, bench)))


def a_case(
    rng: np.random.Generator, kind: Any, shapes: dict[str, tuple[int, ...]], lanes: int
) -> Any:
    """Cases anywhere on their way, most of them with something left to do."""
    names = [name for name, _ in kind._fields_]
    arrays = {name: doubles(rng, *shapes.get(name, ()), lanes) for name in names}
    return kind.filled(**arrays | {"residual": an_open(rng, lanes)})


def doubles(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """See ``numbers``."""
    return numbers(rng, *shape, kind=np.float64)


def an_open(rng: np.random.Generator, lanes: int) -> np.ndarray:
    """Residuals of which most say that there is something left to do."""
    return np.where(rng.random(lanes) < 0.8, 1e3, doubles(rng, lanes))


def a_structure(rng: np.random.Generator, nodes: int, graph: dict[str, np.ndarray]) -> Any:
    """What the kernel of the equilibria needs to know."""
    shapes = {
        "weight": (nodes,),
        **dict.fromkeys(("bar_length", "bar_stiffness"), (len(graph["bars"]),)),
        **dict.fromkeys(("bend_stiffness", "bend_plane", "bend_turn"), (len(graph["bends"]),)),
        "panel_share": (len(graph["panels"]), 4),
        "panel_outline": (len(graph["panels"]),),
        "cylinder_width": (len(graph["cylinders"]),),
    }
    floats, springs = len(graph["floats"]), len(graph["springs"])
    shapes |= dict.fromkeys(("float_stiffness", "float_draft", "float_height"), (floats,))
    shapes |= dict.fromkeys(("spring_place", "spring_stiffness", "spring_preload"), (springs, 3))
    shapes["ground_stiffness"] = (len(graph["grounds"]),)
    return c.AssemblyStruct.filled(
        nodes=nodes,
        ground_level=float(doubles(rng, 1)[0]),
        **{name: len(part) for name, part in graph.items()},
        **{NODES[name]: part for name, part in graph.items()},
        bar_least=rng.choice([0.0, -np.inf], len(graph["bars"])),
        **{name: doubles(rng, *shape) for name, shape in shapes.items()},
    )
