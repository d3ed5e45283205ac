"""A cage followed through changing weather: alone or beside others, whole or broken."""

from dataclasses import dataclass

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.dynamics import AbstractWeather, Damage, follow, simulate
from seacage.ocean import CurrentProfile, SeaState, Waves, sample_waves

# few nodes, for speed: the step is the same, the net coarser
CAGE = Cage.named("ace").altered(
    mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]},
    ropes={"axial_stiffness_n": 7.3e6},
)
BRIEF = {"duration": 20.0, "spin_up": 60.0, "shape_every": 20.0, "time_step": 0.002}


@dataclass(frozen=True, slots=True, kw_only=True)
class Tide(AbstractWeather):
    """A current that turns about, and waves that last."""

    speed: float = 0.4
    period: float = 1e9
    hs: float = 0.0
    growth: float = 0.05

    @property
    def level_depth(self):
        return (0.0, 30.0)

    def current(self, second):
        along = self.speed * np.cos(2.0 * np.pi * second / self.period)
        return np.array([[0.0, along], [0.0, 0.9 * along]])

    def waves(self, second):
        sea = SeaState(current_speed=0.0, current_to=0.0, hs=self.hs, wave_from=200.0)
        waves = sample_waves(sea, seed=3, components=8)
        return Waves(
            amplitude=waves.amplitude,
            angular_frequency=waves.angular_frequency,
            wavenumber=waves.wavenumber,
            phase=waves.phase - waves.angular_frequency * second,
            direction=waves.direction,
            depth=waves.depth,
        )

    def netting(self, second, depth):  # noqa: ARG002 (the growth stays)
        return np.where(depth < 10.0, self.growth, self.growth / 2.0), np.ones(len(depth))


def test_a_stretch_is_the_same_beside_others():
    others = [Tide(speed=0.7, hs=1.0), Tide(hs=0.8), Tide(speed=0.2)]
    together = follow(CAGE, others, [0.0, 100.0, 5000.0], watched=[20], **BRIEF)
    alone = follow(CAGE, others[1:2], [100.0], watched=[20], **BRIEF)
    np.testing.assert_array_equal(together.watched_position[1], alone.watched_position[0])
    np.testing.assert_array_equal(together.bridle_tension[1], alone.bridle_tension[0])
    np.testing.assert_array_equal(together.shape[1], alone.shape[0])
    np.testing.assert_array_equal(together.time[1], 100.0 + 2.0 * np.arange(10))


@dataclass(frozen=True, slots=True, kw_only=True)
class Rippled(Tide):
    """The same with ripples of 3 m, which pipes of half a metre scatter."""

    def waves(self, second):
        waves = super(Rippled, self).waves(second)
        number = 2.0 * np.pi / 3.0
        return Waves(
            amplitude=np.append(waves.amplitude, 0.05),
            angular_frequency=np.append(waves.angular_frequency, np.sqrt(9.81 * number)),
            wavenumber=np.append(waves.wavenumber, number),
            phase=np.append(waves.phase, 0.3),
            direction=np.vstack([waves.direction, [0.0, 1.0]]),
            depth=waves.depth,
        )


def test_waves_that_are_short_against_the_pipes_are_left_out():
    plain, rippled = (
        follow(CAGE, [kind(speed=0.3, hs=1.0)], [50.0], watched=[20], **BRIEF)
        for kind in (Tide, Rippled)
    )
    np.testing.assert_array_equal(plain.watched_position, rippled.watched_position)
    np.testing.assert_array_equal(plain.bridle_tension, rippled.bridle_tension)


@pytest.mark.slow
def test_stretches_join_where_one_ends_and_the_next_begins():
    weather = Tide(speed=0.5, period=4.0 * 3600.0, hs=0.6)
    long = follow(CAGE, [weather], [0.0], watched=[36, 64], **BRIEF | {"duration": 340.0})
    late = follow(CAGE, [weather], [300.0], watched=[36, 64], **BRIEF | {"spin_up": 300.0})
    part = slice(150, 160)
    np.testing.assert_array_equal(long.time[0, part], late.time[0])
    # 5 cm: what is left of another beginning after 300 s, of metres of displacement
    np.testing.assert_allclose(long.watched_position[0, part], late.watched_position[0], atol=0.05)
    # 2 %, and 0.5 kN where a line hangs slack, as one that has just drawn taut bears that much
    # (0.32 measured)
    np.testing.assert_allclose(
        long.bridle_tension[0, part], late.bridle_tension[0], rtol=0.02, atol=500.0
    )


@pytest.mark.slow
def test_in_a_steady_current_the_cage_comes_to_rest_where_simulate_finds_it():
    weather = Tide(speed=0.5, growth=0.0)
    # so that nothing differs but how the wake is found: stiffer ropes come never
    ours = follow(
        CAGE,
        [weather],
        [0.0],
        watched=range(65),
        stiffening=(10.0, 0.5),
        spin_up=300.0,
        duration=20.0,
        shape_every=20.0,
    )
    theirs = simulate(
        CAGE,
        SeaState(current_speed=0.5, current_to=0.0),
        duration=20.0,
        law="loland",
        mooring="catenary",
        current_profile=CurrentProfile(depth=(0.0, 30.0), factor=(1.0, 0.9)),
        sample_every=None,
    )
    pulling = theirs.bridle.mean > 5e3
    assert pulling.sum() >= 4
    # 12 %: the wake in sight leaves more than Løland's on the half that lies behind
    np.testing.assert_allclose(
        ours.bridle_tension[0, -1][pulling],
        theirs.bridle.mean[pulling],
        rtol=0.12,
    )


def test_a_bridle_that_parts_bears_no_more_and_its_neighbours_take_over():
    weather = Tide(speed=0.6)
    cut = (Damage(bridle=7),)  # up-stream, in the middle of its corner's three
    whole = follow(CAGE, [weather], [0.0], **BRIEF)
    parts = follow(CAGE, [weather], [0.0], breaking=cut, **BRIEF)
    before, after = whole.bridle_tension[0], parts.bridle_tension[0]
    assert before[0, 7] > 5e3
    np.testing.assert_array_equal(after[:, 7], 0.0)
    np.testing.assert_array_equal(after[0, :7], before[0, :7])  # at the moment it parts
    assert np.all(after[-1, [6, 8]] > 1.1 * before[-1, [6, 8]])


@pytest.mark.slow
def test_what_is_damaged_from_the_beginning_is_damaged_before_counting_begins():
    weather, cut = Tide(speed=0.6), (Damage(bridle=7),)
    long = follow(CAGE, [weather], [0.0], breaking=cut, **BRIEF | {"duration": 300.0})
    later = follow(CAGE, [weather], [280.0], damaged=cut, **BRIEF | {"spin_up": 280.0})
    # 3 %: both have had 280 s without the bridle
    np.testing.assert_allclose(
        later.bridle_tension[0, -1], long.bridle_tension[0, -1], rtol=0.03, atol=300.0
    )


def test_growth_adds_load():
    bare, grown = follow(CAGE, [Tide(growth=0.0), Tide(growth=0.1)], [0.0, 0.0], **BRIEF).shape[
        :, 0
    ]
    assert grown[CAGE.bottom_node, 1] > bare[CAGE.bottom_node, 1] + 0.3


def test_means_are_those_of_the_samples():
    seen = follow(CAGE, [Tide(hs=1.0)], [0.0], watched=[40], shape_nodes=[40], **BRIEF)
    # 3 cm: a mean over ten samples of waves against one over two hundred
    np.testing.assert_allclose(
        seen.shape[0, 0, 0], seen.watched_position[0, :, 0].mean(0), atol=0.2
    )


def test_progress_ends_at_the_end():
    messages = []
    follow(CAGE, [Tide()], [0.0], progress=lambda *at: messages.append(at), **BRIEF)
    assert messages[-1] == ("follow", 80, 80)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"duration": 21.0}, "duration = 21 s is no whole number of 20 s"),
        ({"every": 0.25}, "every = 0.25 s is no whole number of 0.1 s"),
        ({"time_step": 0.0}, "time_step = 0 s is no step"),
        ({"watched": [65]}, "Give nodes from 0 … 64"),
        ({"spin_up": float("nan")}, "spin_up = nan s"),
    ],
)
def test_what_cannot_be_followed_is_refused(change, sentence):
    with pytest.raises(InputError, match=sentence):
        follow(CAGE, [Tide()], [0.0], **BRIEF | change)


def test_as_many_weathers_as_starts():
    with pytest.raises(InputError, match="1 weathers and 2 starts"):
        follow(CAGE, [Tide()], [0.0, 1.0], **BRIEF)
