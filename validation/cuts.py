"""Newton's laws for parts of the moored cage that are cut out of it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import Cage
from seacage.dynamics import settle
from seacage.dynamics._equilibrium._search import equilibria
from seacage.dynamics._kernel._march import REFRESH, March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Assembly, Body
from seacage.dynamics._physics._flow import steady_flow
from seacage.dynamics._physics._loads import cylinder_force, net_force
from seacage.dynamics._physics._motion import NetLaw, Water, moving_cylinder_force
from seacage.dynamics._physics._wake import wake_share
from seacage.dynamics._time._simulate import HOLD
from seacage.ocean import SeaState, Waves, sample_waves, water_motion
from validation._row import Kind, Row, Section

ACE = Cage.named("ace")
LAW = "loland"
TIME_STEP = 0.002  # s
SPEEDS = (0.25, 0.5, 1.0)
TOWARDS = 25.0
"""Along no symmetry of the mooring [deg]."""

CUTS = {
    "bridles against the water's load on net, collar and tube": "of that load",
    "all lines at a corner, and the water's load there": "of the largest tension",
    "all anchors against the water's load on the whole": "of that load",
}
"""What is cut out, and what the level force left over is a share of."""


def _rows(
    left_over: Sequence[tuple[float, float, float]], of: str, *, source: str, tolerance: float
) -> Iterator[Row]:
    """A row for each cut, of the worst of several cases [%]."""
    worst = np.max(left_over, axis=0).tolist()
    for (what, share), found in zip(CUTS.items(), worst, strict=True):
        yield Row(
            what=f"{of}: {what}, level force left over, {share}",
            unit="%",
            reference=0.0,
            ours=found,
            kind=Kind.CLOSED_FORM,
            source=source,
            tolerance=tolerance,
            reason=f"{tolerance:g} %, as asked of the simulator",
        )


def _at_rest() -> Iterator[Row]:
    return _rows(
        [_left_over(speed) for speed in SPEEDS],
        f"Settled in {SPEEDS[0]:g} to {SPEEDS[-1]:g} m/s",
        source="Newton's first law, by the tensions and anchor loads that `settle` gives",
        tolerance=0.1,
    )


def _left_over(speed: float) -> tuple[float, float, float]:
    """Level force left over at each of the cuts, in the worst corner [%]."""
    sea = SeaState(current_speed=speed, current_to=TOWARDS)
    response, assembly = settle(ACE, sea, law=LAW, mooring="catenary"), anchor_assembly(ACE)
    flow = steady_flow(assembly, sea.current_velocity[None], law=LAW)
    position = equilibria(assembly, flow, starts=2).position
    water = cylinder_force(assembly.cylinders, flow, position)[0, :, :2]
    water += net_force(assembly.panels, flow, position)[0, :, :2]
    ends = assembly.bars.ends[assembly.line_bars]
    along = position[0, ends[:, 1]] - position[0, ends[:, 0]]
    tension = response.line_tension[: len(ends)]  # buoy lines come last, and pull plumb up
    pull = (tension / np.linalg.norm(along, axis=1))[:, None] * along
    nodes, bridles = ACE.node_count, slice(ACE.bridle_count)
    cage = water[:nodes].sum(axis=0)
    corners = water[nodes : nodes + 4] + _at_corners(ends - nodes, pull[:, :2])
    anchors = response.anchor_load[:, :2].sum(axis=0)
    whole = water.sum(axis=0)
    return (
        _percent(cage - pull[bridles, :2].sum(axis=0), cage),
        100.0 * float(np.linalg.norm(corners, axis=1).max() / response.line_tension.max()),
        _percent(whole - anchors, whole),
    )


def _percent(left: Float[np.ndarray, "2"], of: Float[np.ndarray, "2"]) -> float:
    return 100.0 * float(np.linalg.norm(left) / np.linalg.norm(of))


SEAS = (
    SeaState(current_speed=0.2, current_to=TOWARDS, hs=3.0, wave_from=215.0),
    SeaState(current_speed=0.5, current_to=TOWARDS, hs=2.0, wave_from=250.0),
    SeaState(current_speed=0.5, current_to=TOWARDS, hs=2.0, wave_from=30.0),
    SeaState(current_speed=0.8, current_to=TOWARDS, hs=1.0, wave_from=205.0),
)
SPIN_UP, DURATION = 300.0, 300.0
"""Of each, before anything counts and in all that does [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Moving:
    """The cage on its way through the seas: what a march keeps of each.

    Attributes
    ----------
    load
        Mean of the water's load on each body [N].
    anchors
        Mean of the pull on all anchors together [N].
    gained
        Mean acceleration of each node [m/s2].
    position, tension
        Every 0.1 s [m, N].
    """

    assembly: Assembly
    waves: Sequence[Waves]
    load: Float[np.ndarray, "sea body 3"]
    anchors: Float[np.ndarray, "sea 3"]
    gained: Float[np.ndarray, "sea node 3"]
    position: Float[np.ndarray, "sea t node 3"]
    tension: Float[np.ndarray, "sea t line"]

    @classmethod
    def through(cls, seas: Sequence[SeaState]) -> "Moving":
        """Simulated as `simulate` does, from the equilibrium in the current."""
        assembly, depth = scale_mass(anchor_assembly(ACE), TIME_STEP)[0], ACE.site.water_depth
        waves = [sample_waves(sea, seed=seed, depth=depth) for seed, sea in enumerate(seas)]
        current = np.array([sea.current_velocity for sea in seas])
        at_panels = np.repeat(current[:, None], len(assembly.panels.depth), axis=1)
        ocean = Ocean(waves=waves, current=current[:, None], level_z=np.zeros(1), depth=depth)
        law = NetLaw(name=LAW, wake=wake_share(assembly, LAW, at_panels))
        steps = Steps(
            time_step=TIME_STEP,
            each=round(REFRESH / TIME_STEP),
            hold=HOLD,
            ramp=60.0,
            spin_up=round(SPIN_UP / REFRESH),
            counted=round(DURATION / REFRESH),
            sample_every=1,
        )
        start = equilibria(assembly, steady_flow(assembly, current, law=LAW)).position
        march = March(assembly, law, ocean, steps, start)
        march.go(steps.spin_up)
        before = march.velocity
        march.go(steps.counted)
        lanes, counted = slice(len(seas)), float(march.account["counted"][0])
        mean = {
            name: np.moveaxis(march.account[f"{name}_sum"][:, lanes], 1, 0) / counted
            for name in ("load", "anchor")
        }
        samples = {
            name: np.moveaxis(march.samples[name][..., lanes].astype(np.float64), -1, 0)
            for name in ("positions", "tensions")
        }
        return cls(
            assembly=assembly,
            waves=waves,
            load=mean["load"].reshape(len(seas), len(Body), 3),
            anchors=mean["anchor"].reshape(len(seas), -1, 3).sum(axis=1),
            gained=(march.velocity - before) / DURATION,
            position=samples["positions"],
            tension=samples["tensions"],
        )

    def pull(self, sea: int) -> Float[np.ndarray, "line 2"]:
        """Mean level pull of each line on the first end of its bar [N]."""
        ends = self.assembly.bars.ends[self.assembly.line_bars]
        along = self.position[sea][:, ends[:, 1]] - self.position[sea][:, ends[:, 0]]
        unit = along / np.linalg.norm(along, axis=-1, keepdims=True)
        tension = self.tension[sea][:, : len(ends), None]  # buoy lines come last
        return (tension * unit).mean(axis=0)[:, :2]

    def momentum(self, sea: int, nodes: Int[np.ndarray, " n"]) -> Float[np.ndarray, "2"]:
        """Mean level force that some nodes' mass takes up [N]."""
        return (self.assembly.mass[nodes, None] * self.gained[sea, nodes])[:, :2].sum(axis=0)

    def corner_load(self, sea: int) -> Float[np.ndarray, "4 2"]:
        """Mean level load of the water on each corner, by the NumPy definition [N]."""
        pipes, corners = self.assembly.cylinders, ACE.node_count + np.arange(4)
        pipes = pipes.rows(np.flatnonzero(np.any(np.isin(pipes.ends, corners), axis=1)))
        nodes, ends = np.unique(np.append(pipes.ends.ravel(), corners), return_inverse=True)
        place = self.position[sea][:, nodes]
        time = SPIN_UP + REFRESH * np.arange(len(place))[:, None]
        velocity, acceleration = water_motion(self.waves[sea], place, time)
        current = np.broadcast_to(np.append(SEAS[sea].current_velocity, 0.0), place.shape)
        water = Water(
            velocity=velocity,
            acceleration=acceleration,
            elevation=np.zeros(place.shape[:2]),
            current=current,
        )
        own = np.gradient(place, REFRESH, axis=0)
        short = replace(pipes, ends=ends[: pipes.ends.size].reshape(-1, 2))
        load = moving_cylinder_force(short, water, place, own)
        load += self.assembly.water_mass[nodes, None] * acceleration
        return load.mean(axis=0)[np.searchsorted(nodes, corners), :2]


def _in_waves() -> Iterator[Row]:
    moving = Moving.through(SEAS)
    return _rows(
        [_left_over_in_mean(moving, sea) for sea in range(len(SEAS))],
        f"Mean of {DURATION / 60.0:g} min in {len(SEAS)} seas of Hs 1 to 3 m with 0.2 to 0.8 m/s, "
        "the worst",
        source="Newton's second law, by the water's load by body and tensions every 0.1 s",
        tolerance=0.5,
    )


def _left_over_in_mean(moving: Moving, sea: int) -> tuple[float, float, float]:
    """As ``_left_over``, in the mean over time [%]."""
    nodes, pull, load = ACE.node_count, moving.pull(sea), moving.load[sea, :, :2]
    assembly, tension = moving.assembly, moving.tension[sea].mean(axis=0)
    cage = load[[Body.NETTING, Body.COLLAR, Body.TUBE, Body.WAVES]].sum(axis=0)
    held = pull[: ACE.bridle_count].sum(axis=0)
    corners = moving.corner_load(sea) + _at_corners(
        assembly.bars.ends[assembly.line_bars] - nodes, pull
    )
    corners -= np.array([moving.momentum(sea, np.array([nodes + n])) for n in range(4)])
    whole = load.sum(axis=0)
    free = np.flatnonzero(~assembly.fixed)
    return (
        _percent(cage - held - moving.momentum(sea, np.arange(nodes)), cage),
        100.0 * float(np.linalg.norm(corners, axis=1).max() / tension.max()),
        _percent(whole - moving.anchors[sea, :2] - moving.momentum(sea, free), whole),
    )


def _at_corners(
    ends: Int[np.ndarray, "line 2"], pull: Float[np.ndarray, "line 2"]
) -> Float[np.ndarray, "4 2"]:
    """What lines pull the four corners by; ``ends`` counts from the first corner."""
    force = np.zeros((4, 2))
    for end, sign in ((0, 1.0), (1, -1.0)):
        here = (ends[:, end] >= 0) & (ends[:, end] < 4)
        np.add.at(force, ends[here, end], sign * pull[here])
    return force


SECTIONS = (
    Section(
        title="Cuts through the moored cage",
        about="The reference cage on its whole mooring: what the water pushes is what the lines "
        "hold.",
        rows=_at_rest,
    ),
    Section(title="Cuts through the moored cage", about="", rows=_in_waves, slow=True),
)
