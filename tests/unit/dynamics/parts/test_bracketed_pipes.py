"""Two pipes in brackets bend in their plane as a frame of beams does, and alone if they slide."""

import numpy as np
import pytest

from seacage.cage import Cage, Collar
from seacage.conventions import InputError
from seacage.dynamics._parts._assembly import Assembly, bracket_stiffness

ACE = Cage.named("ace")
COLLAR = ACE.collar
ALONE = COLLAR.pipes * COLLAR.pipe_bending_stiffness


def beam(ends, axial, bending):
    """Stiffness of a beam in a plane, of two displacements and a turn at each end."""
    along = ends[1] - ends[0]
    length = np.hypot(*along)
    c, s = along / length
    shear, turn = 12.0 * bending / length**3, 6.0 * bending / length**2
    own = np.zeros((6, 6))
    own[np.ix_([0, 3], [0, 3])] = axial / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    near, far = 4.0 * bending / length, 2.0 * bending / length
    own[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = [
        [shear, turn, -shear, turn],
        [turn, near, -turn, far],
        [-shear, -turn, shear, -turn],
        [turn, far, -turn, near],
    ]
    turned = np.kron(np.eye(2), [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return turned.T @ own @ turned


def ladder_ring(wave_number):
    """EI of the ring of two pipes and all their brackets, beam by beam, for n waves [N m2]."""
    count, radius, half = COLLAR.brackets, COLLAR.radius, COLLAR.pipe_distance / 2.0
    pieces = 2 * count  # of each pipe, two from bracket to bracket
    angle = 2.0 * np.pi * np.arange(pieces) / pieces
    outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    place = np.concatenate([(radius - half) * outward, (radius + half) * outward])
    around = np.stack([np.arange(pieces), np.roll(np.arange(pieces), -1)], axis=1)
    across = np.stack([np.arange(pieces), pieces + np.arange(pieces)], axis=1)[::2]
    matrix = np.zeros((6 * pieces, 6 * pieces))
    for ends in np.concatenate([around, pieces + around, across]):
        rows = (3 * ends[:, None] + np.arange(3)).ravel()
        matrix[np.ix_(rows, rows)] += beam(
            place[ends], COLLAR.pipe_axial_stiffness, COLLAR.pipe_bending_stiffness
        )
    wave = np.cos(wave_number * angle)
    load = np.zeros((2, pieces, 3))
    load[:, :, :2] = np.pi * radius / pieces * wave[:, None] * outward  # 1 N/m on both together
    # as the ring floats freely: the least of all answers
    answer = np.linalg.lstsq(matrix, load.ravel(), rcond=1e-12)[0].reshape(2, pieces, 3)
    gives = 2.0 * np.mean(np.sum(answer[..., :2].mean(axis=0) * outward, axis=1) * wave)
    return radius**4 / (wave_number**2 - 1) ** 2 / gives


@pytest.mark.parametrize(
    ("wave_number", "times"),
    [(2, 11.6), (3, 10.7), (4, 9.7), (5, 8.7), (6, 7.7), (7, 6.9), (8, 6.1)],
)
def test_the_reference_collar_is_some_ten_times_as_stiff_in_its_plane(wave_number, times):
    added = bracket_stiffness(COLLAR, wave_number=wave_number)
    assert 1.0 + added / ALONE == pytest.approx(times, abs=0.05)  # half of the last digit


@pytest.mark.parametrize("wave_number", [2, 4, 6])
def test_the_formula_is_near_a_frame_of_beams(wave_number):
    added = bracket_stiffness(COLLAR, wave_number=wave_number)
    # 3 %: brackets that clamp a pipe in points, in waves of 60/n of them; measured 0.8, 1.5, 2.4
    assert ALONE + added == pytest.approx(ladder_ring(wave_number), rel=0.03)


def test_many_brackets_make_one_beam_of_the_pipes():
    many = ACE.altered(collar={"brackets": 100_000}).collar
    composite = COLLAR.pipe_axial_stiffness * COLLAR.pipe_distance**2 / 2.0
    # the brackets' own flexibility, d a/12, falls with their distance
    assert bracket_stiffness(many) == pytest.approx(composite, rel=1e-3)


@pytest.mark.parametrize("sliding", [{"brackets": 0}, {"brackets": None, "pipe_distance": None}])
def test_pipes_that_slide_bend_each_for_itself(sliding):
    collar = Collar(**{name: getattr(COLLAR, name) for name in COLLAR.__slots__} | sliding)
    assert bracket_stiffness(collar) == 0.0


def test_the_collar_alone_is_stiffer_in_its_plane():
    bends = Assembly.of(ACE).bends
    ratio = 1.0 + bends.plane_stiffness[:32] / bends.stiffness[:32]
    np.testing.assert_allclose(ratio, 9.7, atol=0.05)
    np.testing.assert_array_equal(bends.plane_stiffness[32:], 0.0)  # the tube is one pipe
    np.testing.assert_allclose(bends.plane_turn, 2.0 * np.tan(np.pi / 32.0))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"pipe_distance_m": 0.4}, "pipe_distance_m = 0.4 is less than pipe_diameter_m = 0.5"),
        ({"pipes": 3}, "brackets = 60 hold two pipes together, but pipes = 3"),
    ],
)
def test_brackets_that_cannot_be_are_refused(changes, message):
    with pytest.raises(InputError, match=message):
        ACE.altered(collar=changes)


def test_brackets_need_a_distance():
    lines = [line for line in ACE.to_toml().splitlines() if "pipe_distance_m" not in line]
    with pytest.raises(InputError, match="brackets = 60 need the distance between the pipes"):
        Cage.from_toml("\n".join(lines))
