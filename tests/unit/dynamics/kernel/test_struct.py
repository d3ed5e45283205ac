"""C structs filled from Python keep what they point to, and take no array that is not theirs."""

import ctypes
import gc

import numpy as np
import pytest

from seacage.dynamics._kernel._struct import DOUBLES, FLOATS, INTEGERS, LONGS, Struct, pointer


class Small(Struct):
    _fields_ = (
        ("count", ctypes.c_int32),
        ("level", ctypes.c_float),
        ("floats", FLOATS),
        ("doubles", DOUBLES),
        ("integers", INTEGERS),
        ("longs", LONGS),
        ("law", ctypes.c_float * 2),
    )


def test_a_struct_points_to_the_arrays_it_was_filled_with():
    small = Small.filled(
        count=3,
        level=1.5,
        floats=np.array([1.0, 2.0, 3.0], np.float32),
        doubles=np.array([4.0]),
        integers=np.array([5, 6], np.int32),
        longs=np.array([7], np.int64),
        law=(ctypes.c_float * 2)(8.0, 9.0),
    )
    assert (small.count, small.level) == (3, 1.5)
    assert small.floats[:3] == [1.0, 2.0, 3.0]
    assert (small.doubles[0], small.integers[1], small.longs[0]) == (4.0, 6, 7)
    assert list(small.law) == [8.0, 9.0]


def test_a_struct_keeps_its_arrays_alive():
    small = Small.filled(doubles=np.full(1000, 2.5))
    gc.collect()
    _ = [np.zeros(1000) for _ in range(50)]  # would lie where the array was
    assert small.doubles[:1000] == [2.5] * 1000


def test_an_array_that_is_not_contiguous_is_read_as_it_looks():
    small = Small.filled(doubles=np.arange(12.0).reshape(3, 4)[:, 1])
    assert small.doubles[:3] == [1.0, 5.0, 9.0]


def test_what_c_writes_into_a_contiguous_array_is_seen():
    room = np.zeros(3)
    small = Small.filled(doubles=room)
    small.doubles[1] = 7.0
    np.testing.assert_array_equal(room, [0.0, 7.0, 0.0])


def test_an_array_of_another_kind_is_refused_and_not_misread():
    with pytest.raises(TypeError):
        Small.filled(doubles=np.zeros(3, np.float32))
    with pytest.raises(KeyError):
        pointer(np.zeros(3, np.int8))
