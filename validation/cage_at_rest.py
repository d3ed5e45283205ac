"""The whole cage in a steady current: an independent model, symmetry and the mesh."""

import math
from collections.abc import Callable, Iterator

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage
from seacage.conventions import WATER_DENSITY, has_answer
from seacage.dynamics import Response, settle
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import cylinder_force
from seacage.ocean import SeaState
from validation._case import CASES, read_case
from validation._present_area import settle_on_present_area
from validation._row import Kind, Row, Section

NOTES = "the project's physics notes, section 6"
TENTH = "10 %, as two models of different layers and solvers, and half of the last digit printed"


def current(speed: float, to: float = 0.0) -> SeaState:
    """A uniform current."""
    return SeaState(current_speed=speed, current_to=to)


def _sensitivities() -> Iterator[Row]:
    (cage,) = read_case(CASES / "held_collar_model").subjects
    assert isinstance(cage, Cage)
    dense = 0.0255 * (1.0 - math.sqrt(1.0 - 0.32))
    for name, changed, drag, lost in (
        ("solidity 0.32", cage.altered(netting={"twine_diameter_m": dense}), 92.0, 52.0),
        ("ring of 300 N/m", cage.altered(sinker_tube={"weight_n_m": 300.0}), 54.0, 49.0),
        ("ring of 1000 N/m", cage.altered(sinker_tube={"weight_n_m": 1000.0}), 64.0, 29.0),
    ):
        response = _held(changed)
        what = f"Held cage at 0.5 m/s by Aarsnes' law, {name}"
        yield _model(f"{what}: drag", "kN", drag, float(response.net_force[0, 1]) / 1e3)
        volume = float(cage.volume(cage.design_position))
        found = 100.0 * (1.0 - float(response.volume[0]) / volume)
        yield _model(f"{what}: volume lost of the design shape's", "%", lost, found)
    bare, sheltered = (float(_held(cage, wake=on).net_force[0, 1]) for on in (False, True))
    gain = 100.0 * (bare / sheltered - 1.0)
    what = "Held cage at 0.5 m/s by Aarsnes' law, no wake: what it adds to the drag"
    yield _model(what, "%", 12.0, gain)


def _held(cage: Cage, *, wake: bool = True) -> Response:
    return settle_on_present_area(
        cage, [current(0.5)], law="aarsnes", wake=wake, hold_collar=True, collar_drag=False
    )


def _model(
    what: str, unit: str, reference: float, ours: float, *, must_hold: bool = True, note: str = ""
) -> Row:
    """A row beside a number that the notes print without decimals."""
    return Row(
        what=what,
        unit=unit,
        reference=reference,
        ours=ours,
        kind=Kind.IN_HOUSE_MODEL,
        source=NOTES,
        tolerance=0.10 * reference + 0.5,
        reason=TENTH,
        must_hold=must_hold,
        note=note,
    )


SPEEDS = (0.5, 1.0)
SHARING = ((10.0, 22.0), (27.0, 48.0))
"""Tensions of the least and the most loaded of six up-stream bridles at those speeds [kN]."""


def _shares(cage: Cage) -> Float[np.ndarray, "speed 2"]:
    """The same of ours, on springs under the frame corners [kN]."""
    upstream = cage.design_position[cage.bridle_nodes, 1] < 0.0
    seas = [current(speed) for speed in SPEEDS]
    response = settle_on_present_area(
        cage, seas, law="aarsnes", mooring="springs", collar_drag=False
    )
    tension = response.bridle_tension[:, upstream] / 1e3
    return np.stack([tension.min(axis=1), tension.max(axis=1)], axis=1)


def _sharing() -> Iterator[Row]:
    """How a corner's three bridles share its load, with the prototype's own netting."""
    (cage,) = read_case(CASES / "held_collar_model").subjects
    assert isinstance(cage, Cage)
    ours, free = _shares(cage), _shares(cage.altered(bridles={"pretension_n": 100.0}))
    for case, speed in enumerate(SPEEDS):
        for end, which in enumerate(("least", "most")):
            yield _model(
                f"Cage on corner springs at {speed:g} m/s by Aarsnes' law, no drag on pipes: "
                f"tension of the {which} loaded of six up-stream bridles",
                "kN",
                SHARING[case][end],
                float(ours[case, end]),
                # the one row that a pretension decides which the notes do not print
                must_hold=(case, end) != (0, 0),
                note="The notes do not print the bridles' pretension, which ours have with 10 kN. "
                f"With next to none this bridle carries {free[case, end]:.1f} kN.",
            )


def _pipes() -> Iterator[Row]:
    cage = Cage.named("ace")
    assembly = Assembly.of(cage)
    flow = steady_flow(assembly, np.array([[0.0, 1.0]]), law="aarsnes")
    pipes = cylinder_force(assembly.cylinders, flow, assembly.position[None])[0].sum(axis=0)
    yield _model(
        "Collar and sinker tube at 1 m/s in the design shape: drag", "kN", 37.0, pipes[1] / 1e3
    )
    # a ring across the flow: the mean of |sin|³ round it is 4/3π
    ring = 0.5 * WATER_DENSITY * 1.2 * (0.5 + 0.4) * 2.0 * math.pi * 25.0 * 4.0 / (3.0 * math.pi)
    yield Row(
        what="Collar and sinker tube at 1 m/s in the design shape: drag, closed form",
        unit="kN",
        reference=ring / 1e3,
        ours=float(pipes[1]) / 1e3,
        kind=Kind.CLOSED_FORM,
        source="cross-flow principle, Hoerner (1965): 4/3π of a straight pipe's, along the flow",
        tolerance=0.01 * ring / 1e3,
        reason="1 %: 32 chords for a circle",
    )


def mirrored(cage: Cage) -> Int[np.ndarray, " bridle"]:
    """The bridle on the other side of north for each bridle."""
    bearings = np.array(cage.bridles.bearings)
    away = np.abs((bearings[:, None] + bearings[None, :] + 180.0) % 360.0 - 180.0)
    return np.argmin(away, axis=1)


def _symmetry() -> Iterator[Row]:
    cage = Cage.named("ace")
    response = settle(cage, [current(0.6, to) for to in (20.0, 110.0, 340.0)])
    tension, drag = response.bridle_tension, np.linalg.norm(response.net_force, axis=1)
    for what, unit, found, scale, tolerance, reason in (
        (
            "turned by 90°: largest difference of a bridle's tension",
            "%",
            100.0 * _most(np.roll(tension[0], -3) - tension[1]),
            tension.max(),
            0.1,
            "0.1 % of the largest: what 0.5 N of residual on each node leaves",
        ),
        (
            "mirrored at north: largest difference of a bridle's tension",
            "%",
            100.0 * _most(tension[0][mirrored(cage)] - tension[2]),
            tension.max(),
            0.1,
            "as above",
        ),
        (
            "turned and mirrored: largest difference of the net's load",
            "%",
            100.0 * _most(drag - drag[0]),
            drag[0],
            0.1,
            "as above",
        ),
    ):
        yield _ourselves(f"Current of 0.6 m/s {what}", unit, 0.0, found / scale, tolerance, reason)


def _most(values: Float[np.ndarray, " n"]) -> float:
    return float(np.abs(values).max())


def _ourselves(
    what: str, unit: str, reference: float, ours: float, tolerance: float, reason: str
) -> Row:
    return Row(
        what=what,
        unit=unit,
        reference=reference,
        ours=ours,
        kind=Kind.OURSELVES,
        source="what must not change the answer",
        tolerance=tolerance,
        reason=reason,
    )


def _residuals() -> Iterator[Row]:
    pairs = np.random.default_rng(11).uniform((0.0, 0.0), (1.0, 360.0), (32, 2))
    response = settle(Cage.named("ace"), [current(float(u), float(to)) for u, to in pairs])
    settled = response.residual[has_answer(response.result)]
    yield _ourselves(
        "Equilibria of 32 random currents up to 1 m/s: largest force left on a node",
        "N",
        0.0,
        float(settled.max()),
        0.5,
        f"the solver's own limit; {len(settled)} of 32 settled",
    )


MESH_SPEEDS = (0.25, 0.5, 0.75)


MESHED: tuple[tuple[str, str, float, Callable[[Response, int, Cage], float]], ...] = (
    ("net drag", "kN", 3.0, lambda r, i, _: r.net_force[i, 1] / 1e3),
    ("largest bridle tension", "kN", 3.0, lambda r, i, _: r.bridle_tension[i].max() / 1e3),
    ("volume lost", "%", 5.0, lambda r, i, _: 100.0 * (1.0 - r.volume_fraction[i])),
    (
        "rise of the up-stream edge at 15 m",
        "m",
        5.0,
        lambda r, i, cage: r.node_displacement[i, _upstream_edge(cage), 2],
    ),
)
"""What is compared on two meshes, its unit, the tolerance [%] and how it is read."""


def _mesh() -> Iterator[Row]:
    coarse = Cage.named("ace")
    cages = (coarse, coarse.refined())
    answers = [settle(cage, [current(speed) for speed in MESH_SPEEDS]) for cage in cages]
    for case, speed in enumerate(MESH_SPEEDS):
        for what, unit, percent, read in MESHED:
            ours, finer = (
                float(read(answer, case, cage)) for answer, cage in zip(answers, cages, strict=True)
            )
            yield _ourselves(
                f"Mesh of 10 × 32 beside one of 20 × 64, {speed:g} m/s: {what}",
                unit,
                finer,
                ours,
                percent / 100.0 * abs(finer),
                f"{percent:g} %: 32 chords for a circle, panels that average the flow's angle",
            )


def _upstream_edge(cage: Cage) -> int:
    return cage.node(cage.tube_ring, 3 * cage.spokes // 4)


SECTIONS = (
    Section(
        title="The cage at rest in a current",
        about="Equilibria by `settle`: beside an in-house prototype (it loads the area that a "
        "panel has now, as ours does beside it; its cage, where it is moored, hangs on springs), "
        "turned, mirrored, and on a finer mesh.",
        rows=lambda: [*_sensitivities(), *_sharing(), *_pipes(), *_symmetry(), *_residuals()],
    ),
    Section(
        title="The cage at rest in a current",
        about="On a finer mesh.",
        rows=_mesh,
        slow=True,
    ),
)
