"""Some stretches of time on their way, and what they meet."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from seacage.cage import Cage
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._kernel._march import REFRESH, March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._moored._choice import moor
from seacage.dynamics._moored._detailed import Damage, broken, full_assembly
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._parts._assembly import Assembly
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._motion import NetLaw
from seacage.dynamics._physics._screens import Law, Tuning
from seacage.dynamics._physics._wake import wake_in_sight
from seacage.dynamics._time._forcing import morison_waves
from seacage.ocean import MAX_CURRENT_SPEED, Waves

PerStretch = Float[np.ndarray, " stretch"]
Stretch2 = Float[np.ndarray, "stretch 2"]
StretchNode3 = Float[np.ndarray, "stretch node 3"]
StretchPanel = Float[np.ndarray, "stretch panel"]
HOLD = 8  # time steps through which the water's load is held
RAMP = 60.0  # over which the waves rise when a stretch begins [s]
WAVES_EVERY = 60.0  # between two looks at how the sea state has changed [s]
WAKE_EVERY = 30.0  # between two looks at what shelters what, and at the growth [s]


class AbstractWeather(ABC):
    """Current, waves and growth at one cage over time, in seconds from a time of its own."""

    @property
    @abstractmethod
    def level_depth(self) -> tuple[float, ...]:
        """Depths of the current's levels, from the surface down; the same for all stretches [m]."""

    @abstractmethod
    def current(self, second: float) -> Float[np.ndarray, "level 2"]:
        """East and north at each level [m/s]."""

    @abstractmethod
    def waves(self, second: float) -> Waves:
        """The waves for about a minute from then; their time 0 is then."""

    @abstractmethod
    def netting(
        self, second: float, depth: Float[np.ndarray, " panel"]
    ) -> tuple[Float[np.ndarray, " panel"], Float[np.ndarray, " panel"]]:
        """Solidity added by growth at some depths, and the drag factor of what grew there [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """Samples, refreshes and steps of a stretch."""

    every: float  # between samples [s]
    refreshes: int  # looks at the water between samples
    # Samples' times before counting, and counted
    spin_up: int
    samples: int
    shape_samples: int  # of a mean of the shape
    steps: int  # of time between two looks at the water


@dataclass(frozen=True, slots=True, kw_only=True)
class Build:
    """The cage as it is followed: its law, how its ropes stiffen, how fine its mesh is."""

    cage: Cage
    law: Law
    tuning: Tuning  # changes of a screen law
    stiffening: tuple[float, float]
    refined: int

    def assembly(
        self, damages: tuple[Damage, ...], time_step: float
    ) -> tuple[Assembly, Bool[np.ndarray, " panel"]]:
        """The cage after some damage, steady at a time step, and the panels still there."""
        # steadied before anything breaks: masses must not change on the way
        whole, _ = scale_mass(full_assembly(self.cage, stiffening=self.stiffening), time_step)
        return broken(self.cage, whole, damages, refined=self.refined)


class SegmentBatch:
    """Stretches side by side, each in its own weather; ``march`` moves them all."""

    def __init__(
        self,
        build: Build,
        weathers: Sequence[AbstractWeather],
        starts: PerStretch,
        course: Course,
        damaged: tuple[Damage, ...],
    ) -> None:
        self.cage, self.starts = build.cage, starts
        self._build, self._weathers, self._course = build, weathers, course
        self._time_step = REFRESH / course.steps
        assembly, self._panels = build.assembly(damaged, self._time_step)
        self.assembly = assembly
        begun = starts - course.spin_up * course.every
        current = self._current(begun)
        start = _start(build.cage, assembly, current.mean(axis=1))
        self._solidity, self._drag_factor = self._netting(begun)
        self._wake = self._in_sight(start[:, : build.cage.node_count], current.mean(axis=1))
        self.march = March(
            assembly,
            self._law(),
            Ocean(
                waves=self._waves(begun),
                current=current,
                level_z=-np.array(weathers[0].level_depth),
                depth=build.cage.site.water_depth,
            ),
            Steps(
                time_step=self._time_step,
                each=course.steps,
                hold=HOLD,
                ramp=RAMP,
                spin_up=course.spin_up * course.refreshes,
                counted=course.samples * course.refreshes,
                sample_every=0,
            ),
            start,
        )

    def breaks(self, damages: tuple[Damage, ...]) -> None:
        """From now on these damages are done."""
        self.assembly, self._panels = self._build.assembly(damages, self._time_step)
        self.march.rebuild(self.assembly)

    def meets(self, step: int) -> None:
        """The weather of a sample's time; what changes slowly is looked at now and then."""
        every = self._course.every
        now = self.starts + step * every
        current = self._current(now + every / 2.0)
        self.march.set_current(current)
        since = (step + self._course.spin_up) * every
        if since % WAVES_EVERY < every:
            self.march.set_waves(self._waves(now))
        if since % WAKE_EVERY < every:
            self._solidity, self._drag_factor = self._netting(now)
            self._relax_wake(current.mean(axis=1))
            self.march.set_net(self._law())

    @property
    def bridle_tension(self) -> Float[np.ndarray, "stretch bridle"]:
        """Tension of each bridle, its two ropes together [N]."""
        both = self.march.tension
        return both.reshape(len(both), 2, -1).sum(axis=1)

    def _current(self, at: PerStretch) -> Float[np.ndarray, "stretch level 2"]:
        return np.array([w.current(t) for w, t in zip(self._weathers, at, strict=True)])

    def _waves(self, at: PerStretch) -> list[Waves]:
        """Waves that the pipes do not disturb, as in ``simulate``."""
        waves = [w.waves(t) for w, t in zip(self._weathers, at, strict=True)]
        return morison_waves(waves, self.cage.pipe_diameter)[0]

    def _netting(self, at: PerStretch) -> tuple[StretchPanel, StretchPanel]:
        """Solidity, and drag factor: that of what grew there, and none where netting is gone."""
        panels = self.assembly.panels
        grown = [w.netting(t, panels.depth) for w, t in zip(self._weathers, at, strict=True)]
        added, factor = (np.array(each) for each in zip(*grown, strict=True))
        return panels.solidity + added, factor * self._panels

    def _law(self) -> NetLaw:
        return NetLaw(
            name=self._build.law,
            wake=self._wake,
            solidity=self._solidity,
            drag_factor=self._drag_factor,
            tuning=self._build.tuning,
        )

    def _in_sight(self, net: StretchNode3, current: Stretch2) -> StretchPanel:
        return wake_in_sight(
            self.assembly.panels,
            net,
            current,
            solidity=self._solidity,
            drag_factor=self._drag_factor,
            own_too=self._build.law == "morison",
        )

    def _relax_wake(self, current: Stretch2) -> None:
        """A wake follows what casts it as fast as the water crosses the cage."""
        net = self.march.position[:, : self.cage.node_count]
        across = 2.0 * self.cage.collar.radius
        share = np.minimum(WAKE_EVERY * np.linalg.norm(current, axis=1) / across, 1.0)
        self._wake = self._wake + share[:, None] * (self._in_sight(net, current) - self._wake)


def _start(cage: Cage, assembly: Assembly, current: Stretch2) -> StretchNode3:
    """The cage's equilibria with the tube on its ring, then hung below: near enough to begin."""
    speed = np.linalg.norm(current, axis=1, keepdims=True)
    bounded = current * np.minimum(1.0, MAX_CURRENT_SPEED / np.maximum(speed, 1e-9))
    moored = moor(cage, "catenary")
    settled = equilibria(moored, steady_flow(moored, bounded, law="loland")).position
    known = np.isfinite(settled).all(axis=(1, 2), keepdims=True)
    start = np.repeat(assembly.position[None], len(current), axis=0)
    start[:, : len(moored.position)] = np.where(known, settled, moored.position)
    ring = cage.ring_nodes(cage.tube_ring)
    start[:, -len(ring) :] = start[:, ring] - np.array([0.0, 0.0, cage.sinker_tube.hung_below])
    return start
