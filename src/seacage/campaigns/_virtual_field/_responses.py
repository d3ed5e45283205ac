"""The true cage's answers on a grid of currents and growths, and smoothly between them."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage
from seacage.campaigns._run import campaign_key, run_share
from seacage.campaigns._sea_state_plan import Plan
from seacage.campaigns._virtual_field._truth_parameters import TruthParameters
from seacage.conventions import Progress, Result, SeacageError, no_progress
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, read_campaign

CaseSensor = Float[np.ndarray, "case sensor"]
PerT = Float[np.ndarray, " t"]

_SPEEDS = (0.1, 0.2, 0.3, 0.42, 0.55, 0.7, 0.9, 1.1, 1.35, 1.6)
_DIRECTIONS = tuple(22.5 * number for number in range(16))
_GROWTHS = (0.0, 0.5, 1.0)
_HELD_OUT_GROWTH = 0.25
_HELD_OUT = 31
_WRAP = 4
# Of a shear: its length, and the currents and the growth with which its effect is found
_SHEAR = 0.15
_SHEARED_SPEEDS = (0.1, 0.3, 0.55, 0.9, 1.35)
_SHEARED_GROWTH = 0.5
_HELD_OUT_SHEARED = Plan.named("profile", 0, 16)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Responses:
    """Error-free readings of every sensor of a cage, over currents and growths."""

    speed: Float[np.ndarray, " speed"]  # grid of the current's speed, from 0 [m/s]
    # Grid of where it goes: all round, evenly, an even number [rad], clockwise from north
    direction: Float[np.ndarray, " direction"]
    growth: Float[np.ndarray, " growth"]  # grid of the fouling's growth [-]
    value: Float[np.ndarray, "growth speed direction sensor"]  # depths [m] and tensions [kN]
    # What a shear of 1 m/s to the east and to the north adds; none where it was not settled
    by_shear: tuple["Responses", ...] = ()

    def at(
        self,
        velocity: Float[np.ndarray, "t 2"],
        growth: PerT,
        *,
        shear: Float[np.ndarray, "t 2"] | None = None,
    ) -> Float[np.ndarray, "t sensor"]:
        """Answers to currents (east, north) [m/s] at given growths.

        Cubic in speed and direction, quadratic in growth, linear in ``shear`` [m/s]. Speeds above
        the grid count as its largest. Nothing falls below zero: no line pushes, no sensor leaves
        the water.
        """
        answers = self.answers_of(velocity, growth)
        if shear is not None:
            for slope, part in zip(self.by_shear, shear.T, strict=True):
                answers += part[:, None] * slope.answers_of(velocity, growth)
        return np.maximum(answers, 0.0)

    def answers_of(
        self, velocity: Float[np.ndarray, "t 2"], growth: PerT
    ) -> Float[np.ndarray, "t sensor"]:
        """Answers of any sign, without a shear, as of ``at``."""
        from scipy.interpolate import BarycentricInterpolator

        speed = np.minimum(np.linalg.norm(velocity, axis=1), self.speed[-1])
        direction = np.arctan2(velocity[:, 0], velocity[:, 1]) % (2.0 * np.pi)
        weights = np.ones((1, len(growth)))
        if len(self.growth) > 1:
            weights = BarycentricInterpolator(self.growth, np.eye(len(self.growth)))(growth).T
        answers = np.zeros((len(speed), self.value.shape[-1]))
        for weight, level in zip(weights, self.value, strict=True):
            for sensor in range(self.value.shape[-1]):
                answers[:, sensor] += weight * self._surface(level[..., sensor], speed, direction)
        return answers

    def _surface(
        self, value: Float[np.ndarray, "speed direction"], speed: PerT, direction: PerT
    ) -> PerT:
        """A bicubic spline without a seam at north and without a corner at slack water."""
        from scipy.interpolate import RectBivariateSpline

        # A current of -u towards d is one of u towards d + 180.
        opposite = np.roll(value, len(self.direction) // 2, axis=1)
        through_zero = np.vstack([opposite[:0:-1], value])
        around = np.hstack([through_zero[:, -_WRAP:], through_zero, through_zero[:, :_WRAP]])
        turn, to = 2.0 * np.pi, self.direction
        speeds = np.concatenate([-self.speed[:0:-1], self.speed])
        directions = np.concatenate([to[-_WRAP:] - turn, to, to[:_WRAP] + turn])
        return RectBivariateSpline(speeds, directions, around).ev(speed, direction)


def true_responses(
    cage: Cage,
    hidden: TruthParameters,
    *,
    sheared: bool = False,
    readings: "Callable[[Cage, CampaignRecord], CaseSensor] | None" = None,
    store: Path,
    workers: int | None = None,
    progress: Progress | None = None,
) -> tuple[Responses, CaseSensor]:
    """Settle the true cage on the grid, and at some currents between for the error.

    ``cage``, ``hidden``, ``workers``: as for ``virtual_field``. ``sheared``: whether to find how a
    shear changes the answers, at half the growth. ``readings``: what to interpolate of the settled
    cases, in place of the sensors. ``store``: folder of the campaigns,
    which are kept: another call with the same cage, hidden parameters and version reads them.
    ``progress``: called as ("virtual field", done, total) in cases.

    Returns the responses on the grid, and the error: interpolated less settled, at currents and a
    growth off the grid [m or kN].
    """
    grid = Plan.grid(current_speed=_SPEEDS, current_to=_DIRECTIONS, name="responses")
    between = Plan.sample(0, _HELD_OUT, current_speed=(0.0, 1.2), hs=(0.0, 0.0))
    still = SeaState(current_speed=0.0, current_to=0.0)  # the same however grown the net is
    others = Plan.listed((still, *between.seas), name="still and held out")
    runs = [(growth, grid) for growth in _GROWTHS] + [(_HELD_OUT_GROWTH, others)]
    if sheared:
        runs += [(_SHEARED_GROWTH, _grid_of_shears()), (_HELD_OUT_GROWTH, _HELD_OUT_SHEARED)]
    total = sum(len(plan) for _, plan in runs)
    by, report, before = hidden.equilibria, progress or no_progress, 0

    def report_part(_stage: str, done: int, _part: int) -> None:
        report("virtual field", before + done, total)

    answers: list[CaseSensor] = []
    for growth, plan in runs:
        truth = hidden.true_cage(cage, growth)
        out = store / campaign_key(truth, plan, by)
        run_share(truth, plan, out, by=by, workers=workers, progress=report_part)
        answers.append((readings or _readings)(cage, read_campaign(out)))
        before += len(plan)
    *moving, settled = answers[: len(_GROWTHS) + 1]
    # cases in the order of the grid's plan; still water looks the same in all directions
    by_speed = np.stack(moving).reshape(len(_GROWTHS), len(_SPEEDS), len(_DIRECTIONS), -1)
    still_water = np.broadcast_to(settled[0], by_speed[:, :1].shape)
    responses = Responses(
        speed=np.array([0.0, *_SPEEDS]),
        direction=np.deg2rad(_DIRECTIONS),
        growth=np.array(_GROWTHS),
        value=np.concatenate([still_water, by_speed], axis=1),
        by_shear=_slopes(answers[len(_GROWTHS) + 1]) if sheared else (),
    )
    velocity = np.array([sea.current_velocity for sea in between.seas])
    interpolated = responses.at(velocity, np.full(len(between), _HELD_OUT_GROWTH))
    error = interpolated - settled[1:]
    if sheared:
        seas = _HELD_OUT_SHEARED.seas
        mean, change = (
            np.array([getattr(sea, f"{name}_velocity") for sea in seas])
            for name in ("current", "shear")
        )
        found = responses.at(mean, np.full(len(seas), _HELD_OUT_GROWTH), shear=change)
        error = np.vstack([error, found - answers[-1]])
    return responses, error


def _grid_of_shears() -> Plan:
    """Currents with a shear to the north, east, south and west in turn."""
    currents = product(_SHEARED_SPEEDS, _DIRECTIONS[::2], (0.0, 90.0, 180.0, 270.0))
    return Plan.listed(
        (
            SeaState(current_speed=speed, current_to=to, current_shear=_SHEAR, shear_to=way)
            for speed, to, way in currents
        ),
        name="sheared responses",
    )


def _slopes(settled: CaseSensor) -> tuple[Responses, Responses]:
    """What a shear of 1 m/s to the east and to the north adds; in still water nothing."""
    shape = len(_SHEARED_SPEEDS), len(_DIRECTIONS[::2]), 4, settled.shape[1]
    north, east, south, west = np.moveaxis(settled.reshape(shape), 2, 0) / (2.0 * _SHEAR)
    changes = (np.concatenate([0.0 * one[:1], one])[None] for one in (east - west, north - south))
    first, second = (
        Responses(
            speed=np.array([0.0, *_SHEARED_SPEEDS]),
            direction=np.deg2rad(_DIRECTIONS[::2]),
            growth=np.array([_SHEARED_GROWTH]),
            value=one,
        )
        for one in changes
    )
    return first, second


def _readings(cage: Cage, campaign: CampaignRecord) -> CaseSensor:
    """Depths [m], then tensions [kN], as error-free sensors would read them.

    A shape that was not quite at rest when the solver gave up stands for the one at rest.
    """
    lost = np.flatnonzero(campaign.result == Result.DIVERGED)
    if lost.size:
        raise SeacageError(
            f"The virtual field's cage cannot be settled in {campaign.seas[lost[0]]}: "
            "its hidden parameters are out of reach of the solver. Weaken them."
        )
    nodes = [sensor.node for sensor in cage.depth_sensors]
    bridles = [shackle.bridle for shackle in cage.shackles]
    depth = -campaign.node_position[:, nodes, 2]
    return np.hstack([depth, campaign.bridle_tension[:, bridles] / 1e3])
