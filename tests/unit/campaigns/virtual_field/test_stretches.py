"""Stretches of a virtual field, with a formula in the simulator's place."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from follower import Follower
from seacage.cage import Cage
from seacage.campaigns import Timetable, TruthParameters, generated_current
from seacage.campaigns._virtual_field._stretches import StretchStore, TrueCage, simulate_stretches
from seacage.campaigns._virtual_field._timetable import Stretch, cut
from seacage.campaigns._virtual_field._weather import Weather, true_weather
from seacage.conventions import InputError, RecordError
from seacage.dynamics import Damage, simulation_lanes

HIDDEN = TruthParameters.read()
HOUR = Timetable(stretch=3600.0, mean=1200.0)
EVERY = 60.0
NEVER = np.zeros(1440, bool)
DAY = cut(1440, 60, always=NEVER)
IDENTITY = {"seed": 1, "cage": "some", "buoy_record_sha256": "a"}


@pytest.fixture(scope="module")
def weather() -> Weather:
    buoy = generated_current(0, start=datetime(2020, 1, 18, tzinfo=UTC), days=1.0)
    return true_weather(buoy, None, hidden=HIDDEN, seed=1, every_s=EVERY)


@pytest.fixture
def follower(monkeypatch: pytest.MonkeyPatch) -> Follower:
    fake = Follower()
    monkeypatch.setattr("seacage.campaigns._virtual_field._stretches.follow", fake.follow)
    return fake


def run(
    cage: Cage, weather: Weather, folder: Path, stretches: tuple[Stretch, ...] = DAY
) -> list[float]:
    """Simulate stretches into a folder; what was reported on the way."""
    messages: list[float] = []
    simulate_stretches(
        stretches,
        StretchStore.opened(folder, IDENTITY),
        weather,
        cage=TrueCage.of(cage, HIDDEN),
        timetable=HOUR,
        every=EVERY,
        workers=1,
        report=messages.append,
    )
    return messages


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_the_true_cages_nodes_are_where_the_drawn_ones_are(small_cage: Cage) -> None:
    true = TrueCage.of(small_cage, HIDDEN)
    fine = Cage.from_toml(true.toml)
    assert fine == HIDDEN.fine_cage(small_cage)
    # micrometres: sines of the same angle, computed in another way
    np.testing.assert_allclose(
        fine.design_position[list(true.drawn)], small_cage.design_position, atol=1e-6
    )
    drawn = [sensor.node for sensor in small_cage.depth_sensors]
    np.testing.assert_allclose(
        fine.design_position[list(true.watched)], small_cage.design_position[drawn], atol=1e-6
    )


def test_stretches_are_simulated_side_by_side_from_their_starts(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    result = run(small_cage, weather, tmp_path / "s")
    assert follower.starts == [3600.0 * number for number in range(24)]
    lanes = simulation_lanes()
    assert [len(call["starts"]) for call in follower.calls] == [lanes, 24 - lanes]
    assert result == [0, lanes, 24, 24]
    (query, *_) = follower.calls
    assert (query["law"], query["stiffening"]) == ("loland", (0.01, 0.5))
    assert (query["duration"], query["every"], query["spin_up"]) == (3600.0, EVERY, 300.0)
    assert (query["refined"], query["time_step"], query["shape_every"]) == (2, 0.001, 1200.0)


def test_a_stretch_meets_its_own_part_of_the_weather(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    run(small_cage, weather, tmp_path / "s", DAY[5:6])
    ((own,),) = (call["weathers"] for call in follower.calls)
    for second in (5 * 3600.0 - 300.0, 5 * 3600.0 + 1234.5, 6 * 3600.0):
        np.testing.assert_array_equal(own.current(second), weather.current(second))


def test_damage_reaches_the_simulator(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    cut_through = Damage(bridle=7)
    stretches = cut(180, 60, always=NEVER, breaks=[(90, cut_through)])
    run(small_cage, weather, tmp_path / "s", stretches)
    seen = [(call["starts"], call["damaged"], call["breaking"]) for call in follower.calls]
    assert seen == [
        ([0.0, 3600.0], (), ()),
        ([5400.0], (), (cut_through,)),
        ([9000.0], (cut_through,), ()),
    ]


def test_what_is_kept_is_not_simulated_again_and_ends_in_the_same_bytes(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    run(small_cage, weather, tmp_path / "whole")
    run(small_cage, weather, tmp_path / "parts", DAY[3::2])
    (tmp_path / "parts" / ".00000000.safetensors.unborn").write_bytes(b"half of it")
    follower.calls.clear()
    result = run(small_cage, weather, tmp_path / "parts")
    assert follower.starts == [3600.0 * number for number in (0, 1, 2, *range(4, 24, 2))]
    assert result[0] == 11
    assert contents(tmp_path / "parts") == contents(tmp_path / "whole")


def test_a_stretch_is_read_as_it_was_kept(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    run(small_cage, weather, tmp_path, DAY[:1])
    simulate_group = StretchStore(folder=tmp_path).read(DAY[0])
    assert not simulate_group.lost
    assert simulate_group.watched_position.shape == (60, 3, 3)
    assert simulate_group.shape.shape == (3, small_cage.node_count, 3)
    current = weather.current(0.0)[0, 0]
    # single precision, of 1e4 N
    np.testing.assert_allclose(simulate_group.bridle_tension[10, 3], 1e4 + 3e3 * current, atol=1e-3)
    lifted = simulate_group.shape[0] - small_cage.design_position
    np.testing.assert_allclose(lifted, np.broadcast_to(lifted[0], lifted.shape), atol=1e-5)
    np.testing.assert_array_equal(simulate_group.wave_head, 0.0)  # a calm sea


def test_a_stretch_that_leaves_the_finite_numbers_is_kept_as_lost(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    follower.loses = {3600.0}
    run(small_cage, weather, tmp_path, DAY[:3])
    assert [StretchStore(folder=tmp_path).read(one).lost for one in DAY[:3]] == [False, True, False]


def test_a_folder_of_another_field_is_refused_and_says_what_differs(tmp_path: Path) -> None:
    StretchStore.opened(tmp_path / "s", IDENTITY)
    StretchStore.opened(tmp_path / "s", IDENTITY)
    with pytest.raises(InputError, match=r"another seed and buoy record\. Give another"):
        StretchStore.opened(tmp_path / "s", {**IDENTITY, "seed": 2, "buoy_record_sha256": "b"})


@pytest.mark.parametrize("content", ["no JSON", "[1, 2]"])
def test_a_damaged_manifest_is_refused(tmp_path: Path, content: str) -> None:
    StretchStore.opened(tmp_path, IDENTITY)
    (tmp_path / "manifest.json").write_text(content)
    with pytest.raises(RecordError, match="no manifest of stretches"):
        StretchStore.opened(tmp_path, IDENTITY)


@pytest.mark.parametrize("content", [b"", b"half of a file"])
def test_a_damaged_stretch_is_refused_and_can_be_made_again(
    small_cage: Cage,
    weather: Weather,
    follower: Follower,
    tmp_path: Path,
    content: bytes,
) -> None:
    run(small_cage, weather, tmp_path, DAY[:1])
    kept, (path,) = StretchStore(folder=tmp_path), tmp_path.glob("*.safetensors")
    path.write_bytes(content)
    with pytest.raises(RecordError, match="no finished stretch"):
        kept.read(DAY[0])
    path.unlink()
    run(small_cage, weather, tmp_path, DAY[:1])
    assert not kept.read(DAY[0]).lost


def test_a_stretch_cut_short_is_simulated_whole(
    small_cage: Cage, weather: Weather, follower: Follower, tmp_path: Path
) -> None:
    run(small_cage, weather, tmp_path, (replace(DAY[2], readings=7),))
    assert StretchStore(folder=tmp_path).read(DAY[2]).bridle_tension.shape == (60, 12)
