"""A cage in waves as a looping picture."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from seacage.cage import Cage
from seacage.conventions import InputError
from seacage.figures import Motion, write_animation
from seacage.figures._animation import _patches, write_gif
from seacage.ocean import SeaState, sample_waves, surface_elevation


@pytest.fixture(scope="module")
def cage() -> Cage:
    return Cage.named("ace").altered(mesh={"spokes": 16, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]})


@pytest.fixture(scope="module")
def motion(cage) -> Motion:
    """Three seconds of a cage that rides its waves without bending."""
    sea = SeaState(current_speed=0.5, current_to=90.0, hs=2.0, tp=8.0, wave_from=270.0)
    waves = sample_waves(sea, seed=0)
    time = 100.0 + 0.25 * np.arange(13)
    heave = surface_elevation(waves, np.zeros((1, 2)), time)
    position = np.repeat(cage.design_position[None], len(time), axis=0)
    position[:, :, 2] += heave[:, None]
    tension = np.tile(1e4 * np.arange(12.0), (len(time), 1))
    return Motion(
        time=time,
        node_position=position,
        bridle_tension=tension,
        rest_position=cage.design_position,
        sea=sea,
        waves=waves,
    )


@pytest.fixture(scope="module")
def picture(tmp_path_factory, cage, motion):
    path = tmp_path_factory.mktemp("gif") / "cage.gif"
    return write_animation(path, cage, motion, frames_per_second=5.0, width=320)


def test_it_runs_in_real_time_and_loops_for_ever(picture):
    with Image.open(picture) as gif:
        assert gif.n_frames == 16
        assert gif.info["loop"] == 0
        played = 0.0
        for frame in range(gif.n_frames):
            gif.seek(frame)
            played += gif.info["duration"]
    assert played == 16 * 200


def test_it_reports_how_far_it_is(tmp_path, cage, motion):
    messages = []
    write_animation(
        tmp_path / "a.gif",
        cage,
        motion,
        frames_per_second=2.0,
        width=160,
        progress=lambda *where: messages.append(where),
    )
    assert messages == [("draw", picture, 7) for picture in range(1, 8)]


def test_it_is_as_wide_as_requested_and_light(picture):
    with Image.open(picture) as gif:
        assert gif.width == 320
        assert gif.convert("RGB").getpixel((2, 2)) == (255, 255, 255)


def test_the_net_is_seen_to_move(picture):
    with Image.open(picture) as gif:
        first = np.array(gif.convert("RGB"))
        gif.seek(8)
        later = np.array(gif.convert("RGB"))
    upper = slice(0, 2 * first.shape[0] // 3)
    assert np.mean(np.any(first[upper] != later[upper], axis=2)) > 0.01


def test_moments_between_the_samples_are_met_smoothly(motion):
    fine = motion.sampled(0.1)
    assert len(fine.time) == 31
    exact = surface_elevation(motion.waves, np.zeros((1, 2)), fine.time)
    heave = fine.node_position[:, 0, 2]
    # A cubic through quarter seconds of waves longer than 2 s.
    np.testing.assert_allclose(heave, exact, atol=0.01)


def test_no_spline_makes_a_rope_push(motion):
    slack = np.zeros_like(motion.bridle_tension)
    slack[6] = 1e4
    assert replace(motion, bridle_tension=slack).sampled(0.05).bridle_tension.min() == 0.0


def test_a_cage_without_waves_or_tension_is_drawn_too(tmp_path, cage, motion):
    still = replace(motion, waves=None, bridle_tension=np.zeros_like(motion.bridle_tension))
    assert write_animation(tmp_path / "a.gif", cage, still, width=160).stat().st_size > 0


def test_odd_spokes_are_drawn_panel_by_panel(tmp_path, motion):
    odd = Cage.named("ace").altered(mesh={"spokes": 15, "ring_depths_m": [0.0, 7.0, 15.0, 23.0]})
    position = np.repeat(odd.design_position[None], len(motion.time), axis=0)
    moved = replace(motion, node_position=position, rest_position=odd.design_position)
    assert write_animation(tmp_path / "a.gif", odd, moved, width=160).stat().st_size > 0


def test_patches_cover_what_their_panels_cover(cage):
    def area(corners):
        x, y = np.moveaxis(cage.design_position[corners][..., :2], -1, 0)
        return np.abs(np.sum(x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1), axis=1)) / 2.0

    patches = _patches(cage)
    assert len(patches) == len(cage.panels) // 2
    # Seen from above, the cone alone has an area; rounding of sums of squares of 25 m.
    np.testing.assert_allclose(
        area(patches), area(cage.panels).reshape(-1, 2).sum(axis=1), atol=1e-9
    )


def test_a_diverged_case_is_refused(motion):
    lost = motion.node_position.copy()
    lost[-1, 0] = np.nan
    with pytest.raises(InputError, match="diverged"):
        replace(motion, node_position=lost)


def test_three_moments_are_too_few(motion):
    with pytest.raises(InputError, match="3 moments are too few"):
        replace(
            motion,
            time=motion.time[:3],
            node_position=motion.node_position[:3],
            bridle_tension=motion.bridle_tension[:3],
        )


def test_another_ending_is_refused(tmp_path, cage, motion):
    with pytest.raises(InputError, match=r"End the name in \.gif"):
        write_animation(tmp_path / "a.mp4", cage, motion)


def test_hundredths_are_spread_so_that_the_whole_keeps_time(tmp_path):
    pictures = [np.full((4, 4, 3), 255 * (frame % 2), dtype=np.uint8) for frame in range(8)]
    write_gif(tmp_path / "a.gif", pictures, colours=["#ffffff", "#000000"], seconds=0.125)
    with Image.open(tmp_path / "a.gif") as read:
        played = []
        for frame in range(read.n_frames):
            read.seek(frame)
            played.append(read.info["duration"])
    assert set(played) == {120, 130}
    assert sum(played) == 1000


def test_pictures_faster_than_browsers_show_are_refused(tmp_path):
    with pytest.raises(InputError, match="fewer pictures a second"):
        write_gif(tmp_path / "a.gif", [], colours=["#ffffff"], seconds=0.01)
