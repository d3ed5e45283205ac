"""Arrays with one row for each part: some of them, taken back, and put together."""

from dataclasses import dataclass

import numpy as np

from seacage.conventions import Rows
from seacage.dynamics._parts._assembly import Bends, Floats


def bends(nodes, stiffness):
    zero = np.zeros(len(nodes))
    return Bends(
        nodes=nodes, stiffness=np.array(stiffness), plane_stiffness=zero, plane_turn=zero.copy()
    )


BENDS = bends(np.arange(12).reshape(4, 3), [1.0, 2.0, 3.0, 4.0])


def test_some_rows_are_copies_in_the_order_requested():
    some = BENDS.rows(np.array([2, 0]))
    np.testing.assert_array_equal(some.nodes, [[6, 7, 8], [0, 1, 2]])
    some.stiffness[:] = 0.0
    np.testing.assert_array_equal(BENDS.stiffness, [1.0, 2.0, 3.0, 4.0])
    np.testing.assert_array_equal(BENDS.rows(BENDS.stiffness > 2.5).stiffness, [3.0, 4.0])


def test_rows_that_are_taken_back_leave_the_others_alone():
    whole = BENDS.rows(np.arange(4))
    other = bends(np.full((2, 3), 9), [30.0, 10.0])
    whole.take(np.array([2, 0]), other)
    np.testing.assert_array_equal(whole.stiffness, [10.0, 2.0, 30.0, 4.0])
    np.testing.assert_array_equal(whole.nodes[:, 0], [9, 3, 9, 9])


def test_several_are_joined_in_their_order():
    box = Floats(
        nodes=np.array([3]),
        stiffness=np.array([1.0]),
        draft=np.array([0.1]),
        height=np.array([0.2]),
    )
    joined = Floats.joined(box, box.rows(np.array([], dtype=int)), box)
    np.testing.assert_array_equal(joined.nodes, [3, 3])
    np.testing.assert_array_equal(joined.height, [0.2, 0.2])


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Moored(Rows):
    name: str
    floats: Floats
    load: np.ndarray


def test_rows_within_rows_follow_and_other_fields_stay():
    box = Floats(
        nodes=np.array([3, 4]),
        stiffness=np.array([1.0, 2.0]),
        draft=np.array([0.1, 0.1]),
        height=np.array([0.2, 0.3]),
    )
    moored = Moored(name="ace", floats=box, load=np.array([5.0, 6.0]))
    last = moored.rows(slice(1, None))
    assert last.name == "ace"
    np.testing.assert_array_equal(last.floats.nodes, [4])
    both = Moored.joined(last, moored)
    np.testing.assert_array_equal(both.floats.height, [0.3, 0.2, 0.3])
    np.testing.assert_array_equal(both.load, [6.0, 5.0, 6.0])


def test_no_rows_have_the_shapes_and_kinds_that_are_declared():
    none = Bends.none()
    assert (none.nodes.shape, none.nodes.dtype) == ((0, 3), np.int64)
    assert (none.stiffness.shape, none.stiffness.dtype) == ((0,), np.float64)
