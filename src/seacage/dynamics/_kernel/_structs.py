"""The kernel's structs as Python lays them out and fills them, and their check against C's."""

import ctypes
from typing import Any, ClassVar, Self

import numpy as np

from seacage.conventions import SeacageError

KINDS: dict[Any, Any] = {
    np.dtype(np.float32): ctypes.POINTER(ctypes.c_float),
    np.dtype(np.float64): ctypes.POINTER(ctypes.c_double),
    np.dtype(np.int32): ctypes.POINTER(ctypes.c_int32),
    np.dtype(np.int64): ctypes.POINTER(ctypes.c_int64),
}

FLOATS, DOUBLES, INTEGERS, LONGS = KINDS.values()
_DTYPES = {kind: dtype for dtype, kind in KINDS.items()}


def pointer(array: np.ndarray) -> Any:
    """To the first number of an array."""
    return array.ctypes.data_as(KINDS[array.dtype])


def by_name(value: Any) -> dict[str, Any]:
    """Fields of a dataclass with slots, by their names, which the C structs share."""
    return {name: getattr(value, name) for name in value.__slots__}


class Struct(ctypes.Structure):
    """A C struct that keeps the arrays it points to alive, by name in ``arrays``.

    ``c_name`` is its name in C, where a table ``seacage_layout_<c_name>`` holds its layout.
    """

    c_name: ClassVar[str]
    arrays: dict[str, np.ndarray]

    @classmethod
    def filled(cls, **values: Any) -> Self:
        """Of numbers and arrays.

        An array that C will write into must be contiguous, or C writes into a copy.
        """
        kinds, struct = cls._kinds(), cls()
        struct.arrays = dict[str, np.ndarray]()
        for name, value in values.items():
            if isinstance(value, np.ndarray) and kinds[name] in _DTYPES:
                struct.arrays[name] = np.ascontiguousarray(value)
                setattr(struct, name, pointer(struct.arrays[name]))
            else:
                setattr(struct, name, value)
        return struct

    @classmethod
    def cast(cls, **values: Any) -> Self:
        """Of numbers, and of arrays that C only reads: each is turned into its field's kind."""
        kinds = cls._kinds()
        arrays = {
            name: np.asarray(value, _DTYPES[kinds[name]])
            for name, value in values.items()
            if isinstance(value, np.ndarray)
        }
        return cls.filled(**values | arrays)

    @classmethod
    def _kinds(cls) -> dict[str, Any]:
        return {name: kind for name, kind, *_ in cls._fields_}


class _Row(ctypes.Structure):
    """A field of a struct in C's own table; the last row has no name and the struct's size."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("offset", ctypes.c_int32),
        ("size", ctypes.c_int32),
    )


def check_layout(library: ctypes.CDLL, struct: type[Struct]) -> None:
    """Refuse a library whose C lays a struct out otherwise than Python does.

    Raises
    ------
    SeacageError
        Another name, place or size of a field, or another size of the whole.
    """
    fields = [(name, getattr(struct, name)) for name, *_ in struct._fields_]
    rows = [(name.encode(), field.offset, field.size) for name, field in fields]
    expected = [*rows, (None, 0, ctypes.sizeof(struct))]
    try:
        table = (_Row * len(expected)).in_dll(library, f"seacage_layout_{struct.c_name}")
    except ValueError:
        table = (_Row * len(expected))()
    for (name, offset, size), row in zip(expected, table, strict=True):
        # C's table may be the shorter one: nothing is read behind the first row that differs
        if (row.name, row.offset, row.size) != (name, offset, size):
            raise SeacageError(
                f"The compiled kernel is not of this version of seacage: C and Python differ on "
                f"{name.decode() if name else 'the size'} of struct {struct.c_name!r}. Install "
                "seacage again, which compiles it."
            )


def _each(kind: Any, names: str) -> tuple[tuple[str, Any], ...]:
    """Fields of one kind, their names between spaces."""
    return tuple((name, kind) for name in names.split())


# Equilibria: double precision


class AssemblyStruct(Struct):
    c_name = "assembly"
    _fields_ = (
        *_each(ctypes.c_int32, "nodes bars bends panels cylinders floats springs grounds"),
        *_each(INTEGERS, "bar_ends bend_nodes panel_corners cylinder_ends float_nodes"),
        *_each(INTEGERS, "spring_nodes ground_nodes"),
        *_each(DOUBLES, "weight bar_length bar_stiffness bar_least"),
        *_each(DOUBLES, "bend_stiffness bend_plane bend_turn panel_share panel_outline"),
        *_each(DOUBLES, "cylinder_width float_stiffness float_draft float_height"),
        *_each(DOUBLES, "spring_place spring_stiffness spring_preload ground_stiffness"),
        ("ground_level", ctypes.c_double),
    )


class FlowStruct(Struct):
    c_name = "flow"
    _fields_ = _each(DOUBLES, "direction panel pipe_pressure")


class RelaxationStruct(Struct):
    c_name = "relaxation"
    _fields_ = (
        *_each(DOUBLES, "inverse_mass soft_rate true_rate"),
        *_each(ctypes.c_double, "tolerance progress most_damping"),
        *_each(ctypes.c_int32, "patience steps rounds"),
    )


class RelaxingStruct(Struct):
    c_name = "relaxing"
    _fields_ = _each(DOUBLES, "position velocity carried damping best stalled rounds residual")


class PatternStruct(Struct):
    c_name = "pattern"
    _fields_ = (
        *_each(INTEGERS, "row diagonal column order bars bends panels cylinders floats springs"),
        ("grounds", INTEGERS),
    )


class BalanceStruct(Struct):
    c_name = "balance"
    _fields_ = (
        *_each(DOUBLES, "free true_rate"),
        *_each(ctypes.c_double, "tolerance reach least_barrier least_shift most_shift"),
        ("iterations", ctypes.c_int32),
    )


class BalancingStruct(Struct):
    c_name = "balancing"
    _fields_ = _each(DOUBLES, "position tension barrier shift moved sign iterations residual")


class BenchStruct(Struct):
    c_name = "bench"
    _fields_ = (*_each(DOUBLES, "truth force step zero tension bar blocks"), ("place", INTEGERS))


# The march: single precision


class BodyStruct(Struct):
    c_name = "body"
    _fields_ = (
        *_each(ctypes.c_int32, "nodes bars bends panels cylinders floats springs grounds lines"),
        *_each(ctypes.c_int32, "buoys twines slenders cage_nodes"),
        *_each(INTEGERS, "bar_ends bend_nodes panel_corners cylinder_ends float_nodes"),
        *_each(INTEGERS, "spring_nodes ground_nodes line_bars line_floats slender_nodes"),
        *_each(INTEGERS, "cylinder_body twine_bars anchor_bars"),
        *_each(FLOATS, "weight mass water_mass place chord slender_tangent slender_mass"),
        *_each(FLOATS, "bar_length bar_rate bar_damping bar_least"),
        *_each(FLOATS, "bend_stiffness bend_plane bend_turn panel_share panel_outline panel_mass"),
        *_each(FLOATS, "cylinder_drag cylinder_skin"),
        *_each(FLOATS, "float_stiffness float_draft float_height"),
        *_each(FLOATS, "spring_place spring_stiffness spring_preload spring_damping"),
        *_each(FLOATS, "ground_stiffness cylinder_series"),
        ("ground_level", ctypes.c_float),
    )


class NettingStruct(Struct):
    c_name = "netting"
    _fields_ = (
        ("kind", ctypes.c_int32),
        *_each(FLOATS, "law drag_factor wake all"),
    )


class SeaStruct(Struct):
    c_name = "sea"
    _fields_ = (
        *_each(ctypes.c_int32, "components levels spread"),
        ("shallow", INTEGERS),
        *_each(DOUBLES, "turns turns_per_second"),
        *_each(FLOATS, "number toward_x toward_y amplitude speed reach floor bounce"),
        *_each(FLOATS, "level_z current"),
        ("depth", ctypes.c_float),
    )


class ScheduleStruct(Struct):
    c_name = "schedule"
    _fields_ = (
        *_each(ctypes.c_double, "time_step ramp"),
        *_each(ctypes.c_int64, "first refreshes count_from sample_every"),
        *_each(ctypes.c_int32, "steps hold"),
    )


class StateStruct(Struct):
    c_name = "state"
    _fields_ = (
        *_each(FLOATS, "position rest velocity water slope current relative force base held"),
        *_each(
            FLOATS, "drag elevation rise panel_current panel_factor panel_drag panel_lift lost_at"
        ),
    )


class RecordStruct(Struct):
    c_name = "record"
    _fields_ = (
        *_each(DOUBLES, "node_sum node_square"),
        *_each(FLOATS, "node_least node_most"),
        *_each(DOUBLES, "line_sum line_square"),
        *_each(FLOATS, "line_least line_most"),
        *_each(DOUBLES, "load_sum load_square"),
        *_each(FLOATS, "load_least load_most"),
        *_each(LONGS, "counted sampled"),
        ("twine_sum", DOUBLES),
        *_each(FLOATS, "twine_most twine_slack"),
        ("anchor_sum", DOUBLES),
        ("uplift_most", FLOATS),
        *_each(FLOATS, "positions elevations loads tensions"),
    )


STRUCTS = tuple(Struct.__subclasses__())
"""All structs that Python fills for the kernel."""
