"""What the water loads is what the lines hold: cuts through a moored cage in waves balance."""

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.dynamics._kernel._march import March, Steps
from seacage.dynamics._kernel._march_inputs import Ocean
from seacage.dynamics._moored._mass_scaling import scale_mass
from seacage.dynamics._moored._mooring import anchor_assembly
from seacage.dynamics._parts._assembly import Body
from seacage.dynamics._physics._motion import NetLaw
from seacage.ocean import SeaState, sample_waves

CAGE = Cage.named("ace").altered(
    mesh={
        "spokes": 8,
        "ring_depths_m": [0.0, 7.0, 15.0],
        "cylinder_depth_m": 15.0,
        "tip_depth_m": 21.0,
    }
)
SEA = SeaState(current_speed=0.5, current_to=30.0, hs=2.0, tp=7.0, wave_from=230.0)
SECONDS, BEFORE, EVERY = 120, 150, 0.1
HALF_PERCENT = 0.005


class Run:
    """A march through waves: its mean loads, and the mean pull of each line on its first end."""

    def __init__(self):
        self.assembly, _ = scale_mass(anchor_assembly(CAGE), 0.002)
        depth = CAGE.site.water_depth
        ocean = Ocean(
            waves=[sample_waves(SEA, seed=0, depth=depth)],
            current=np.array([SEA.current_velocity])[:, None],
            level_z=np.zeros(1),
            depth=depth,
        )
        law = NetLaw(name="loland", wake=np.full((1, len(self.assembly.panels.area)), 0.9))
        steps = Steps(
            time_step=0.002,
            each=50,
            hold=4,
            ramp=20.0,
            spin_up=10 * BEFORE,
            counted=10 * SECONDS,
            sample_every=1,
        )
        march = March(self.assembly, law, ocean, steps, self.assembly.position[None])
        march.go(10 * BEFORE)
        first = march.velocity[0]
        march.go(10 * SECONDS)
        self.gained = (march.velocity[0] - first) / SECONDS  # mean acceleration
        counted = float(march.account["counted"][0])
        self.loads = march.account["load_sum"][:, 0].reshape(len(Body), 3) / counted
        self.position = march.samples["positions"][..., 0].astype(np.float64)
        self.tension = march.samples["tensions"][..., 0].astype(np.float64)
        self.anchor_pull = march.account["anchor_sum"][:, 0].reshape(-1, 3) / counted

    def pull(self, lines):
        """Mean pull of some lines on the second end of their bar, towards the first [N]."""
        first, second = self.assembly.bars.ends[self.assembly.line_bars[lines]].T
        along = self.position[:, first] - self.position[:, second]
        unit = along / np.linalg.norm(along, axis=-1, keepdims=True)
        return (self.tension[:, lines, None] * unit).mean(axis=0)

    def momentum(self, nodes):
        """Mean of the force that some nodes' mass takes up [N]."""
        return (self.assembly.mass[nodes, None] * self.gained[nodes]).sum(axis=0)


@pytest.fixture(scope="module")
def run():
    return Run()


def kind(run, name):
    return np.flatnonzero([one == name for one in run.assembly.lines.kinds])


def test_bridles_hold_what_the_water_loads_on_netting_collar_and_tube(run):
    water = run.loads[[Body.NETTING, Body.COLLAR, Body.TUBE, Body.WAVES]].sum(axis=0)
    held = run.pull(kind(run, "bridle")).sum(axis=0)  # a bridle's bar ends at the collar
    left = water + held - run.momentum(np.arange(CAGE.node_count))
    assert np.linalg.norm(left[:2]) <= HALF_PERCENT * np.linalg.norm(water[:2])


def test_the_anchors_hold_the_whole_load(run):
    whole = run.loads.sum(axis=0)
    held = run.anchor_pull.sum(axis=0)  # on the anchors, away from the load
    left = whole - held - run.momentum(np.flatnonzero(~run.assembly.fixed))
    assert np.linalg.norm(left[:2]) <= HALF_PERCENT * np.linalg.norm(whole[:2])


def test_only_anchor_lines_pull_on_an_anchor(run):
    anchored = kind(run, "anchor line")
    others = np.setdiff1d(np.arange(len(run.tension[0])), anchored)
    np.testing.assert_array_equal(run.anchor_pull[others], 0.0)
    assert np.all(run.anchor_pull[anchored, 2] >= 0.0)
    assert np.all(run.anchor_pull[anchored, 2] <= run.tension[:, anchored].mean(axis=0))
