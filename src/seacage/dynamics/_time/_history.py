"""Result of a simulation in time: series and their statistics, from what the kernel kept."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.conventions import Result
from seacage.dynamics._kernel._march import REFRESH, March
from seacage.dynamics._moored._ends import mooring_result
from seacage.dynamics._parts._assembly import Assembly, Body
from seacage.dynamics._time._line_loads import LineLoads, line_loads
from seacage.dynamics._time._simulation import Simulation
from seacage.dynamics._time._statistics import Statistics, WaterLoad
from seacage.dynamics._time._twines import PanelTwines, panel_twines

Node3 = Float[np.ndarray, "node 3"]
PerQuantile = Float[np.ndarray, " quantile"]
VOLUMES = 360  # at most so many samples give the volume's statistics: it changes slowly, and costs
_SHARED = ("time", "nodes", "quantile_levels", "names", "kinds", "capacity", "tn_slope", "warnings")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class History:
    """A cage in waves and current: one case without the leading axis, or several with it.

    A case that diverged holds NaN from then on, and in all its statistics.
    """

    # Of the series, from the end of the spin-up; empty where no series was requested [s]
    time: Float[np.ndarray, " t"]
    # Series: of the chosen nodes [m], of tensions, the bridles being the first of all lines [N],
    # and of the surface at the origin [m]
    nodes: Int[np.ndarray, " kept"]
    node_position: Float[np.ndarray, "*case t kept 3"]
    bridle_tension: Float[np.ndarray, "*case t bridle"]
    line_tension: Float[np.ndarray, "*case t line"]
    surface_elevation: Float[np.ndarray, "*case t"]
    node: Statistics  # of all nodes' positions [m]
    bridle: Statistics  # of the bridles' tensions [N]
    net_force: Statistics  # of the water's load on the netting [N]
    volume: Statistics  # of the volume inside the net [m3]
    lines: LineLoads  # of all lines
    water_load: WaterLoad  # on netting, collar, sinker tube and ropes
    twines: PanelTwines  # tension in each panel of the netting, in the order of ``Cage.panels``
    node_displacement: Float[np.ndarray, "*case node 3"]  # mean position less the rest shape [m]
    volume_fraction: Float[np.ndarray, "*case"]  # mean volume over that in still water [-]
    quantile_levels: Float[np.ndarray, " quantile"]  # between 0 and 1 [-]
    # Mean over time of the products of all coordinates, as displacements from the design shape:
    # (node and axis) × (node and axis) [m2]; of no rows unless requested
    second_moment: Float[np.ndarray, "*case coordinate coordinate"]
    # Share of Hs in waves that are too short for the loads on the collar's pipes, and are left out:
    # those below eight pipe diameters, 1.6 s for 0.5 m [-]
    hs_left_out: Float[np.ndarray, "*case"]
    # Of ``seacage.conventions.Result``; all but those of a case that diverged are kept
    result: Int[np.ndarray, "*case"]
    # Simulated time at which a case was given up, spin-up included; NaN for the others [s]
    diverged_at: Float[np.ndarray, "*case"]
    warnings: tuple[str, ...]  # sentences on where loads were used beyond what is known of them


def histories(
    simulation: Simulation, assembly: Assembly, march: March, rest: Node3
) -> list[History]:
    """One for each case of a march that has ended, or one for all its pieces of a single case."""
    if simulation.pieces > 1:
        return [_history(simulation, assembly, march, rest, range(march.cases))]
    return [_history(simulation, assembly, march, rest, [case]) for case in range(march.cases)]


def _history(
    simulation: Simulation, assembly: Assembly, march: March, rest: Node3, lanes: Sequence[int]
) -> History:
    """Of one case, whose pieces lie in some lanes in the order of time."""
    cage, steps, levels = simulation.cage, march.steps, simulation.quantile_levels
    sampled = {name: _in_turn(values, lanes) for name, values in march.samples.items()}
    net = np.ascontiguousarray(sampled["positions"][:, : cage.node_count])
    counted = int(march.account["counted"][0]) * len(lanes)

    def moments(what: str, count: int, origin: np.ndarray) -> dict[str, np.ndarray]:
        account = {
            how: _join(march, f"{what}_{how}", lanes)[: origin.size].reshape(origin.shape)
            for how in ("sum", "square", "least", "most")
        }
        return _moments(account, count, origin)

    def of(what: str, sample: np.ndarray, count: int, origin: np.ndarray) -> Statistics:
        return Statistics(**moments(what, count, origin), quantile=_quantiles(sample, levels))

    every = max(1, -(-len(net) // VOLUMES))
    volume = cage.volume(net[::every].astype(np.float64))
    node = of("node", net, counted, assembly.position[: cage.node_count])
    tension = sampled["tensions"][:: steps.sample_every]
    lines = of("line", tension, counted * steps.each, np.zeros(len(assembly.anchor_bars)))
    bridles = slice(len(assembly.bridles))
    collar = node.mean[assembly.collar, 2].mean(keepdims=True)
    ended, every_tension = np.array([Result.CONVERGED]), sampled["tensions"][:, None]
    kept = slice(None) if simulation.series else slice(0)
    waves = march.has_waves(lanes[0])
    at_anchor = assembly.anchor_bars >= 0
    buoys = assembly.floats.rows(assembly.line_floats)
    pull = _join(march, "anchor_sum", lanes).reshape(-1, 3) / counted
    history = History(
        time=(np.arange(len(net)) * steps.sample_every * REFRESH)[kept],
        nodes=simulation.nodes,
        node_position=net[kept, simulation.nodes].astype(np.float64),
        bridle_tension=tension[kept, bridles].astype(np.float64),
        line_tension=tension[kept].astype(np.float64),
        surface_elevation=sampled["elevations"][kept].astype(np.float64),
        node=node,
        bridle=_each([lines], lambda values: values[0][..., bridles]),
        net_force=of("load", sampled["loads"], counted, np.zeros(3)),  # rows of the netting first
        volume=_plain_statistics(volume, levels),
        lines=line_loads(
            assembly.lines,
            lines,
            sampled["tensions"],
            anchor_pull=np.where(at_anchor[:, None], pull, np.nan),
            uplift=np.where(at_anchor, _join(march, "uplift_most", lanes), np.nan),
            most=np.append(np.full(len(assembly.line_bars), np.inf), buoys.buoyancy),
            every=REFRESH,
            waves=waves,
        ),
        water_load=WaterLoad(**moments("load", counted, np.zeros((len(Body), 3)))),
        twines=panel_twines(
            cage,
            assembly,
            total=_join(march, "twine_sum", lanes),
            most=_join(march, "twine_most", lanes),
            slack=_join(march, "twine_slack", lanes),
            counted=counted,
        ),
        node_displacement=node.mean - rest,
        volume_fraction=np.asarray(volume.mean() / cage.volume(rest)),
        quantile_levels=levels,
        second_moment=_second_moment(simulation, net),
        hs_left_out=np.asarray(0.0),
        result=mooring_result(cage, assembly, ended, collar, every_tension).reshape(()),
        diverged_at=np.asarray(_time_of_loss(march, lanes)),
        warnings=(),
    )
    return _mask_lost(history, march) if np.isfinite(history.diverged_at) else history


def _join(march: March, name: str, lanes: Sequence[int]) -> np.ndarray:
    """A number of the account over some lanes: the least, the most, or the sum."""
    join = {"least": np.min, "most": np.max}.get(name.split("_")[1], np.sum)
    return join(march.account[name][:, lanes], axis=1)


def _moments(
    account: dict[str, np.ndarray], count: int, origin: np.ndarray
) -> dict[str, np.ndarray]:
    """Mean, standard deviation and extremes, of an account that is kept from an origin."""
    mean = account["sum"] / count
    return {
        "mean": mean + origin,
        "std": np.sqrt(np.maximum(account["square"] / count - mean**2, 0.0)),
        "minimum": account["least"].astype(np.float64),
        "maximum": account["most"].astype(np.float64),
    }


def _in_turn(values: np.ndarray, lanes: Sequence[int]) -> np.ndarray:
    """Samples of some lanes, the last axis, one after the other along the first."""
    if len(lanes) == 1:
        return values[..., lanes[0]]
    return np.concatenate([values[..., lane] for lane in lanes])


def _time_of_loss(march: March, lanes: Sequence[int]) -> float:
    """Time since the start of the first piece at which a piece was lost first, else NaN [s]."""
    before = np.arange(len(lanes)) * march.steps.counted * REFRESH
    lost = march.lost_at[lanes] + before
    return float(np.nanmin(lost)) if np.isfinite(lost).any() else np.nan


def _second_moment(
    simulation: Simulation, net: Float[np.ndarray, "t node 3"]
) -> Float[np.ndarray, "coordinate coordinate"]:
    if not simulation.second_moment:
        return np.zeros((0, 0))
    design = simulation.cage.design_position.astype(np.float32)
    moved = (net - design).reshape(len(net), -1)
    return (moved.T @ moved).astype(np.float64) / len(net)


def _plain_statistics(sample: Float[np.ndarray, " t"], levels: PerQuantile) -> Statistics:
    return Statistics(
        mean=np.asarray(sample.mean()),
        std=np.asarray(sample.std()),
        minimum=np.asarray(sample.min()),
        maximum=np.asarray(sample.max()),
        quantile=_quantiles(sample, levels),
    )


def _quantiles(
    sample: Float[np.ndarray, "t *shape"], levels: PerQuantile
) -> Float[np.ndarray, "quantile *shape"]:
    """Linear between order statistics; sorting rows is several times quicker than columns."""
    rows = np.sort(np.ascontiguousarray(np.moveaxis(sample, 0, -1)), axis=-1)
    at = levels * (rows.shape[-1] - 1)
    low = np.floor(at).astype(np.int64)
    high = np.ceil(at).astype(np.int64)
    between = rows[..., low] + (at - low) * (rows[..., high] - rows[..., low])
    return np.moveaxis(between.astype(np.float64), -1, 0)


def _mask_lost(history: History, march: March) -> History:
    """A case that left the finite numbers: nothing of it can be trusted but what was before."""
    gone = history.time + march.steps.spin_up * REFRESH >= float(history.diverged_at)

    def after(series: np.ndarray) -> np.ndarray:
        return np.where(gone.reshape(-1, *(1,) * (series.ndim - 1)), np.nan, series)

    def nothing(values: list[np.ndarray]) -> np.ndarray:
        return np.full_like(values[0], np.nan)

    series = ("node_position", "bridle_tension", "line_tension")
    lost = ("node", "bridle", "net_force", "volume", "lines", "water_load", "twines")
    lost += ("node_displacement", "volume_fraction", "second_moment")
    return replace(
        history,
        result=np.asarray(Result.DIVERGED),
        **{name: after(getattr(history, name)) for name in series},
        **{name: _each([getattr(history, name)], nothing) for name in lost},
    )


def _each(several: list[Any], join: Callable[[list[np.ndarray]], np.ndarray]) -> Any:
    """Several arrays joined to one, or several dataclasses array by array."""
    if not is_dataclass(several[0]):
        return join(several)

    def merge(name: str) -> Any:
        values = [getattr(one, name) for one in several]
        return values[0] if name in _SHARED else _each(values, join)

    return type(several[0])(**{f.name: merge(f.name) for f in fields(several[0])})


def stack(cases: list[History]) -> History:
    """Several cases as one history, with a leading axis."""
    return _each(cases, np.stack)
