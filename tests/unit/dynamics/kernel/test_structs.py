"""C structs filled from Python: what they point to, and their layout against C's."""

import ctypes
import gc

import numpy as np
import pytest

from seacage.conventions import SeacageError
from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._kernel._structs import (
    DOUBLES,
    FLOATS,
    INTEGERS,
    LONGS,
    STRUCTS,
    ScheduleStruct,
    Struct,
    check_layout,
    pointer,
)


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


def test_what_c_only_reads_is_turned_into_the_kind_of_its_field():
    small = Small.cast(count=2, integers=np.array([5, 6]), floats=np.array([0.1, -np.inf]))
    assert (small.count, small.integers[:2]) == (2, [5, 6])
    assert small.floats[:2] == [np.float32(0.1), -np.inf]


# The layout


@pytest.mark.parametrize("struct", STRUCTS, ids=lambda struct: struct.c_name)
def test_python_and_c_lay_every_struct_out_alike(struct):
    check_layout(kernel().library, struct)


FIELDS = ScheduleStruct._fields_
WRONG = {
    "time_step": [("time_step", ctypes.c_float), *FIELDS[1:]],
    "first": [FIELDS[0], *FIELDS[2:]],
    "hold": [*FIELDS[:-2], FIELDS[-1], FIELDS[-2]],
    "more": [*FIELDS, ("more", ctypes.c_double)],
    "the size": FIELDS[:-1],
}
"""Wrong layouts, by the first field at which they differ."""


@pytest.mark.parametrize("field", WRONG)
def test_a_struct_laid_out_otherwise_than_in_c_is_refused(field):
    class Schedule(Struct):
        c_name = "schedule"
        _fields_ = tuple(WRONG[field])

    with pytest.raises(SeacageError, match=rf"differ on {field} of struct 'schedule'\. Install"):
        check_layout(kernel().library, Schedule)


def test_a_library_that_has_no_table_of_a_struct_is_refused():
    class Missing(Struct):
        c_name = "missing"
        _fields_ = FIELDS

    with pytest.raises(SeacageError, match=r"not of this version .* of struct 'missing'"):
        check_layout(kernel().library, Missing)
