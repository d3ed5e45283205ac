"""Discrepancy of a twin's shapes from a virtual field's true ones, and its reliability."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.campaigns import TrueShapes, TruthParameters, true_shapes
from seacage.conventions import Origin, Progress
from seacage.twin import Discrepancy, Metocean, PredictedNet, Twin

SEEDS = tuple(range(6))
# Of the virtual field, and times of each, that a demonstration's twin learns its error from
CASES = 120

# Standard deviation of the test points about the predicted net [m]: an ROV's distances
SCATTERED = 4.0


_NOW = datetime(2020, 1, 18, tzinfo=UTC)  # any time will do


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reliability:
    """Predicted probabilities of some events, and what was observed."""

    p: Float[np.ndarray, " event"]  # that the true net is nearer than the given distance [-]
    observed: Bool[np.ndarray, " event"]  # whether it was
    speed: Float[np.ndarray, " event"]  # of the current that the buoy reported [m/s]

    def table(self, *, bins: int = 10) -> list[tuple[int, float, float]]:
        """Reliability: events, mean probability and share that was observed, by probability."""
        number = np.minimum((self.p * bins).astype(int), bins - 1)
        rows = (number == one for one in np.unique(number))
        return [
            (int(row.sum()), float(self.p[row].mean()), float(self.observed[row].mean()))
            for row in rows
        ]


def learned_discrepancy(
    twin: Twin,
    *,
    hidden: TruthParameters | None = None,
    seeds: Sequence[int] = SEEDS,
    cases: int = CASES,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Discrepancy:
    """Estimate how far a virtual field's true nets are from a twin's shapes.

    Virtual field: at a farm the truth would have to be measured, by sonar or by divers; until
    it is, this is an assumption about how such shapes err.

    ``twin``: whose shapes.
    ``hidden``: how the true cage differs; None for that of cage ``ace``.
    ``seeds``, ``cases``, ``workers``, ``progress``: as for ``true_shapes``.
    """
    shapes = true_shapes(
        twin.cage,
        hidden=hidden or TruthParameters.read(),
        seeds=seeds,
        cases=cases,
        workers=workers,
        progress=progress,
    )
    velocity = shapes.current_velocity
    answer = twin.predict(Metocean.without_waves(velocity))
    return Discrepancy.fit(
        twin.cage,
        velocity,
        predicted=answer.node_position,
        true=shapes.node_position,
        origin=Origin.VIRTUAL_FIELD,
        level=answer.shape_level,
    )


def score_points(
    twin: Twin, shapes: TrueShapes, *, points: int = 60, below: float = 1.0, seed: int = 0
) -> Reliability:
    """Compare predicted clearances of points near the net with those of true nets.

    ``twin``: its inputs are what the buoy reported.
    ``shapes``: held out from its training.
    ``points``, ``seed``: for each shape, scattered about the predicted net.
    ``below``: the distance of the event [m].
    """
    random = np.random.default_rng(seed)
    predicted, observed, speed = list[np.ndarray](), list[np.ndarray](), list[float]()
    for velocity, true in zip(shapes.current_velocity, shapes.node_position, strict=True):
        net = PredictedNet.under(twin, Metocean.without_waves(velocity[None]), t=_NOW)
        point = _near(net, random, points)
        predicted.append(net.clearance(point, below=below).p_below)
        observed.append(twin.cage.nearest(point, true).distance < below)
        speed += [float(np.hypot(*velocity))] * len(point)
    return Reliability(
        p=np.concatenate(predicted), observed=np.concatenate(observed), speed=np.array(speed)
    )


def score_paths(
    twin: Twin, shapes: TrueShapes, *, paths: int = 6, below: float = 1.0, seed: int = 0
) -> Reliability:
    """Compare predicted clearances of straight paths through and around the net.

    A path begins somewhere near the cage and ends some 15 m off.
    """
    random = np.random.default_rng(seed)
    predicted, observed, speed = list[float](), list[bool](), list[float]()
    for velocity, true in zip(shapes.current_velocity, shapes.node_position, strict=True):
        net = PredictedNet.under(twin, Metocean.without_waves(velocity[None]), t=_NOW)
        for _ in range(paths):
            along = net.along(_path(net, random), below=below)
            predicted.append(along.p_below)
            observed.append(bool(twin.cage.nearest(along.point, true).distance.min() < below))
            speed.append(float(np.hypot(*velocity)))
    return Reliability(p=np.array(predicted), observed=np.array(observed), speed=np.array(speed))


def without_drift(
    difference: Float[np.ndarray, "case node 3"],  # between the positions of nodes [m]
    # Nodes of the collar, whose mean displacement counts as the drift
    collar: Int[np.ndarray, " spoke"],
) -> Float[np.ndarray, "case node 3"]:
    """Differences of two nets that are shifted so that their collars lie together [m]."""
    return difference - difference[:, collar].mean(axis=1, keepdims=True)


def _near(
    net: PredictedNet, random: np.random.Generator, points: int
) -> Float[np.ndarray, "point 3"]:
    corners = net.node_position[net.cage.panels[random.integers(len(net.cage.panels), size=points)]]
    share = random.dirichlet(np.ones(4), points)
    point = np.einsum("pk,pkj->pj", share, corners) + SCATTERED * random.normal(size=(points, 3))
    # Where an ROV swims.
    return np.minimum(point, [np.inf, np.inf, -0.5])


def _path(net: PredictedNet, random: np.random.Generator) -> Float[np.ndarray, "corner 3"]:
    radius, depth = net.cage.collar.radius, net.cage.mesh.tip_depth
    angle, away = random.uniform(0.0, 2.0 * np.pi), random.uniform(0.2, 1.4) * radius
    start = np.array(
        [away * np.cos(angle), away * np.sin(angle), -random.uniform(0.05, 0.8) * depth]
    )
    end = start + random.normal(size=3) * [10.0, 10.0, 3.0]
    return np.minimum(np.stack([start, end]), [np.inf, np.inf, -1.0])
