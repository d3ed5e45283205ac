"""C structs filled from Python, which keep the arrays they point to alive."""

import ctypes
from typing import Any, Self

import numpy as np

KINDS: dict[Any, Any] = {
    np.dtype(np.float32): ctypes.POINTER(ctypes.c_float),
    np.dtype(np.float64): ctypes.POINTER(ctypes.c_double),
    np.dtype(np.int32): ctypes.POINTER(ctypes.c_int32),
    np.dtype(np.int64): ctypes.POINTER(ctypes.c_int64),
}

FLOATS, DOUBLES, INTEGERS, LONGS = KINDS.values()


def pointer(array: np.ndarray) -> Any:
    """To the first number of an array."""
    return array.ctypes.data_as(KINDS[array.dtype])


class Struct(ctypes.Structure):
    """A C struct; ``_fields_`` names what is filled in, in order, ``arrays`` what it points to."""

    arrays: dict[str, np.ndarray]

    @classmethod
    def filled(cls, *in_order: Any, **values: Any) -> Self:
        """Of numbers and arrays, in the fields' order or by name.

        An array that C will write into must be contiguous, or C writes into a copy.
        """
        types = {name: kind for name, kind, *_ in cls._fields_}
        values |= zip(types, in_order, strict=False)
        struct = cls()
        struct.arrays = dict[str, np.ndarray]()
        for name, value in values.items():
            if isinstance(value, np.ndarray) and types[name] in KINDS.values():
                struct.arrays[name] = np.ascontiguousarray(value)
                setattr(struct, name, pointer(struct.arrays[name]))
            else:
                setattr(struct, name, value)
        return struct
