"""A cage's drawing names its parts and gives its dimensions."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.figures import cage_drawing_figure

ACE = Cage.named("ace")


def evenly(bridles: int) -> Cage:
    """The reference cage with another number of bridles."""
    bearings = ((np.arange(bridles) + 0.5) * 360.0 / bridles).tolist()
    held = {"bearings_deg": bearings, "length_offset_m": [0.0] * bridles}
    return replace(ACE, shackle=ACE.shackle[:1]).altered(bridles=held)


def texts(cage: Cage) -> str:
    figure = cage_drawing_figure(cage)
    return "\n".join(text.get_text() for axes in figure.axes for text in axes.texts)


def test_every_part_is_named_and_every_dimension_given():
    found = texts(ACE)
    corners = [f"corner {number}" for number in range(1, 5)]
    rings = [f"ring {number}, {depth:g} m" for number, depth in enumerate(ACE.mesh.ring_depths)]
    lines = [f"{kind}-{n}" for kind, most in (("anchor", 8), ("buoy", 4)) for n in range(1, most)]
    for name in (*ACE.bridle_names, *ACE.sensor_names, *corners, *rings, *lines, "frame-1, 85.0 m"):
        assert name in found
    for dimension in ("50.0 m across", "157.1 m round", "tip 31 m", "cylinder 15 m", "tube 18 m"):
        assert dimension in found
    assert "sea bed, 191 m deep, drawn nearer" in found


def test_a_sea_bed_close_to_the_net_is_drawn_where_it_is():
    assert "drawn nearer" not in texts(ACE.altered(site={"water_depth_m": 40.0}))


@pytest.mark.parametrize("cage", [ACE, evenly(8), evenly(16), ACE.rotated(25.0)])
def test_no_name_lies_on_another(cage):
    """Boxes of level texts: those along lines at an angle have larger boxes than letters."""
    figure = cage_drawing_figure(cage)
    figure.draw_without_rendering()
    for axes in figure.axes:
        level = [t for t in axes.texts if t.get_text() and t.get_rotation() % 90.0 == 0.0]
        # A pixel less on each side: letters do not fill their boxes.
        boxes = [text.get_window_extent().padded(-1.0) for text in level]
        for (one, a), (other, b) in combinations(zip(level, boxes, strict=True), 2):
            assert not a.overlaps(b), (one.get_text(), other.get_text())


def test_a_cage_without_sensors_and_a_frame_of_six_corners_are_drawn():
    angle = np.pi / 3.0 * np.arange(6)
    east, north = (tuple((50.0 * f(angle)).tolist()) for f in (np.cos, np.sin))
    frame = replace(ACE.frame, side=None, corners_east=east, corners_north=north)
    bare = replace(ACE, shackle=(), depth_sensor=(), frame=frame)
    assert "corner 6" in texts(bare)
    assert "shackle" not in texts(bare)
