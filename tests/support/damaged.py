"""What sensors of a damaged cage read: kept answers of settled cages, and how they were made.

``damaged_ace.npz`` holds cage ``ace`` with the hidden parameters of its virtual field: whole, with
bridle-8 parted, and with a hole of 6 × 6 of its 320 panels below the depth sensors. Where the
physics or the hidden parameters change, ``PYTHONPATH=src python tests/support/damaged.py`` makes
the file again: 1,440 equilibria.
"""

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np

from seacage.cage import Cage
from seacage.campaigns import TruthParameters, generated_current
from seacage.campaigns._virtual_field._field import _settle
from seacage.campaigns._virtual_field._responses import _DIRECTIONS, _GROWTHS, _SPEEDS, Responses
from seacage.campaigns._virtual_field._timetable import reading_times
from seacage.dynamics import Damage
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._moored._choice import moor
from seacage.dynamics._moored._detailed import _tear
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import bar_tension
from seacage.ocean import SeaState
from seacage.records import FieldRecord

ACE = Cage.named("ace")
DAMAGES = {"whole": Damage(), "parted": Damage(bridle=7), "torn": Damage(hole=(2, 24, 6))}
"""Bridle 7, counted from 0, is bridle-8: the middle one of a corner, with a shackle."""

_KEPT = Path(__file__).with_name("damaged_ace.npz")


def kept_answers(damage: str) -> Responses:
    """The kept answers of one of ``DAMAGES``."""
    with np.load(_KEPT) as kept:
        value = kept[damage].astype(float)
    return Responses(
        speed=np.array([0.0, *_SPEEDS]),
        direction=np.deg2rad(_DIRECTIONS),
        growth=np.array(_GROWTHS),
        value=value,
    )


def damaged_field(
    damage: str, *, hidden: TruthParameters, seed: int, start: datetime, days: float, every_s: float
) -> FieldRecord:
    """What the sensors say where the cage is damaged from the start; whatever the damage, the
    same weather, noise and outages."""
    buoy = generated_current(seed, start=start, days=days)
    times = reading_times(buoy, every_s)
    nothing_held_out = np.zeros((1, len(ACE.sensor_names)))
    answers = kept_answers(damage)
    return _settle(ACE, buoy, times, answers, nothing_held_out, hidden=hidden, seed=seed).record


def settled_answers(damage: str, hidden: TruthParameters, growth: float, seas: Sequence[SeaState]):
    """Settle the damaged cage: depths [m], then tensions [kN], of each sea."""
    cage, broken = hidden.true_cage(ACE, growth), DAMAGES[damage]
    assembly = moor(cage, "catenary")
    stiffness = assembly.bars.stiffness.copy()
    whole = np.ones(len(assembly.panels.area), dtype=bool)
    if broken.bridle is not None:
        stiffness[assembly.bridles[broken.bridle]] = 0.0
    if broken.hole is not None:
        _tear(cage, broken.hole, stiffness, whole)
    assembly = replace(assembly, bars=replace(assembly.bars, stiffness=stiffness))
    velocity = np.array([sea.current_velocity for sea in seas])
    flow = steady_flow(assembly, velocity, law=hidden.law, wake=True, pipe_drag=True)
    flow = replace(flow, pressure=flow.pressure * whole)
    found = equilibria(assembly, flow)
    tension = bar_tension(assembly.bars, found.position)[:, assembly.bridles]
    nodes = [sensor.node for sensor in cage.depth_sensors]
    lines = [shackle.bridle for shackle in cage.shackles]
    return np.hstack([-found.position[:, nodes, 2], tension[:, lines] / 1e3])


def answers_on_the_grid(damage: str, hidden: TruthParameters) -> np.ndarray:
    """Answers of one of ``DAMAGES`` at every growth, speed and direction of a settled field."""
    still = [SeaState(current_speed=0.0, current_to=0.0)]
    moving = [SeaState(current_speed=u, current_to=to) for u in _SPEEDS for to in _DIRECTIONS]
    at_rest = settled_answers(damage, hidden, _GROWTHS[0], still)
    grids = []
    for growth in _GROWTHS:
        answers = settled_answers(damage, hidden, growth, moving)
        by_speed = answers.reshape(len(_SPEEDS), len(_DIRECTIONS), -1)
        grids.append(np.concatenate([np.broadcast_to(at_rest, (1, *by_speed.shape[1:])), by_speed]))
    return np.stack(grids).astype(np.float32)


if __name__ == "__main__":
    np.savez_compressed(
        _KEPT, **{damage: answers_on_the_grid(damage, TruthParameters.read()) for damage in DAMAGES}
    )
