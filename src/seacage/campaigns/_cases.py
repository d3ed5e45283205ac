"""Simulator of a campaign's cases, and the work of one block of them."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from importlib.metadata import version
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from seacage.cage import cage_or_structure
from seacage.campaigns._pool import one_thread
from seacage.conventions import InputError, SeacageError, has_answer
from seacage.dynamics import (
    PHYSICS,
    History,
    Mooring,
    law_label,
    settle,
    simulate,
    simulation_lanes,
)
from seacage.ocean import SeaState

# Cases computed and written at a time: enough to fill the kernel's lanes, few enough to lose
_BLOCK = {"simulate": 16, "settle": 32}

_cage = lru_cache(maxsize=4)(cage_or_structure)
_PIECE = 60.0  # least length of the pieces that a case on a mooring of its own is simulated in [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Simulator:
    """Simulator of a campaign's cases: all that their numbers depend on beside cage and sea."""

    # "simulate": each sea state in time, with irregular waves of its own seed. "settle": the
    # equilibrium in its current, with the waves' mean loads.
    method: Literal["simulate", "settle"] = "simulate"
    # Name of the load law of the netting, of seacage or installed; "morison", twine by twine, in
    # time only
    law: str = "kristiansen-faltinsen"
    # Changes of a screen law, as for ``settle``
    skin_friction: float | None = None
    lift_factor: float = 1.0
    # "catenary": frame ropes, buoys and anchor lines; or "springs" under the frame's corners
    mooring: Mooring = "catenary"
    # Time over which the waves grow, and time before the statistics begin, the ramp included [s]
    ramp: float = 60.0
    spin_up: float = 300.0
    time_step: float = 0.002  # [s]
    quantile_levels: Sequence[float] = (0.05, 0.5, 0.95)  # of the quantiles over time [-]
    # Whether to keep the second moment of all node coordinates over the campaign
    second_moment: bool = True
    # Whether each case has a mooring of its own, ``Cage.drawn`` by a seed of the case. It is
    # simulated alone, in pieces of a minute and more.
    draw_mooring: bool = False
    # Names of lines that bear nothing. Each case starts from the equilibrium without them, where
    # one is found: what happens while they part is not in it.
    parted: Sequence[str] = ()

    def __post_init__(self) -> None:
        for name in ("quantile_levels", "parted"):  # hashed with the rest
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if self.method not in _BLOCK:
            raise InputError(f"Simulator: method {self.method!r} is none of {', '.join(_BLOCK)}.")
        if not self.in_time and self.law == "morison":
            raise InputError(
                "Simulator: an equilibrium knows no law 'morison'. Choose a screen law, or "
                "simulate in time."
            )
        law_label(self.law)  # refused now where it is not installed

    @property
    def in_time(self) -> bool:
        """Whether cases are simulated in time, with waves."""
        return self.method == "simulate"

    @property
    def block(self) -> int:
        """Cases computed and written at a time."""
        return _BLOCK[self.method]

    @property
    def attributes(self) -> dict[str, Any]:
        """What to write into a store, with units, beside ``law`` and ``method``."""
        drawn = {"mooring_drawn": 1} if self.draw_mooring else {}
        without = {"parted": ", ".join(self.parted)} if self.parted else {}
        tuned = {} if self.skin_friction is None else {"skin_friction": self.skin_friction}
        tuned |= {} if self.lift_factor == 1.0 else {"lift_factor": self.lift_factor}
        moored: dict[str, Any] = {"mooring": self.mooring, **tuned, **drawn, **without}
        if not self.in_time:
            return moored
        return moored | {
            "ramp_s": self.ramp,
            "spin_up_s": self.spin_up,
            "time_step_s": self.time_step,
            "quantile_levels": list(self.quantile_levels),
            "second_moment_kept": int(self.second_moment),
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseBlock:
    """Neighbouring cases, as they travel to a worker; with seeds where moorings are drawn."""

    first: int
    cage_toml: str
    seas: tuple[SeaState, ...]
    wave_seeds: tuple[int, ...]
    duration: float
    simulator: Simulator
    made_by: str
    mooring_seeds: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answers:
    """Results of a block: variables of the store, and their cost."""

    values: dict[str, np.ndarray]  # by the names of the store
    # Sum of the converged cases' second moments [m2]
    moment: Float[np.ndarray, "coordinate coordinate"] | None
    core_seconds: float  # processor time [s]


def software_version(law: str) -> str:
    """What runs here: seacage, the revision of its physics, and a law that is not its own."""
    label = law_label(law)
    own = "" if label == law else f", law {label}"
    return f"seacage {version('seacage')}, physics {PHYSICS}{own}"


def answer_block(block: CaseBlock) -> Answers:
    """Compute one block.

    Raises SeacageError: the worker runs another version of seacage, or of a law, than who asks.
    """
    if (here := software_version(block.simulator.law)) != block.made_by:
        raise SeacageError(
            f"A worker runs {here}, the campaign {block.made_by}: their numbers may differ. "
            "Install the same version on every worker."
        )
    began = time.process_time()
    with one_thread():
        answer = _simulate_block if block.simulator.in_time else _settle_block
        values, moments = zip(*(answer(one) for one in _alike(block)), strict=True)
    return Answers(
        values={name: np.concatenate([one[name] for one in values]) for name in values[0]},
        moment=None if moments[0] is None else np.sum(moments, axis=0),
        core_seconds=time.process_time() - began,
    )


def _alike(block: CaseBlock) -> list[CaseBlock]:
    """Blocks of cases on one mooring: the block itself, or each case on the one drawn for it."""
    if not block.mooring_seeds:
        return [block]
    cage, alone = _cage(block.cage_toml), replace(block, mooring_seeds=())
    return [
        replace(alone, cage_toml=cage.drawn(drawn).to_toml(), seas=(sea,), wave_seeds=(wave,))
        for sea, wave, drawn in zip(block.seas, block.wave_seeds, block.mooring_seeds, strict=True)
    ]


def _settle_block(block: CaseBlock) -> tuple[dict[str, np.ndarray], None]:
    loads = ("law", "skin_friction", "lift_factor", "mooring", "parted")
    settings = {name: getattr(block.simulator, name) for name in loads}
    response = settle(_cage(block.cage_toml), block.seas, mean_waves=True, **settings)
    names = ("node_position", "bridle_tension", "net_force", "volume", "residual", "result")
    return {name: getattr(response, name) for name in names}, None


def _simulate_block(
    block: CaseBlock,
) -> tuple[dict[str, np.ndarray], Float[np.ndarray, "coordinate coordinate"] | None]:
    by = block.simulator
    pieces = max(1, min(simulation_lanes(), int(block.duration // _PIECE)))
    ours = ("method", "draw_mooring")
    settings = {one.name: getattr(by, one.name) for one in fields(by) if one.name not in ours}
    history = simulate(
        _cage(block.cage_toml),
        block.seas,
        duration=block.duration,
        seed=block.wave_seeds,
        sample_every=None,
        pieces=pieces if by.draw_mooring else 1,
        **settings,
    )
    return _statistics(history), _moment(history) if by.second_moment else None


def _statistics(history: History) -> dict[str, np.ndarray]:
    values = {f"line_{name}": each for name, each in history.lines.columns.items()}
    values |= {"result": history.result, "diverged_at": history.diverged_at}
    ranges = ("std", "minimum", "maximum", "quantile")
    for name, over_time, kinds in (
        ("node_position", history.node, ranges),
        ("bridle_tension", history.bridle, ranges),
        ("net_force", history.net_force, ("std",)),
        ("volume", history.volume, ("std",)),
    ):
        values |= {name: over_time.mean}
        values |= {f"{name}_{kind}": getattr(over_time, kind) for kind in kinds}
    return values


def _moment(history: History) -> Float[np.ndarray, "coordinate coordinate"]:
    """Sum over the cases to learn from, one after the other: the order is part of the number."""
    total = np.zeros(history.second_moment.shape[-2:])
    for case in np.flatnonzero(has_answer(history.result)):
        total += history.second_moment[case]
    return total.astype(np.float32)
