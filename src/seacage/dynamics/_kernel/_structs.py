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

    _fields_ = (("name", ctypes.c_char_p), ("offset", ctypes.c_int32), ("size", ctypes.c_int32))


def check_layout(library: ctypes.CDLL, struct: type[Struct]) -> None:
    """Refuse a library whose C lays a struct out otherwise than Python does.

    Raises SeacageError: another name, place or size of a field, or another size of the whole.
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


def _struct(c_name: str, *fields: tuple[Any, str]) -> type[Struct]:
    """A struct of fields of one kind after another, their names between spaces."""
    each = [(name, kind) for kind, names in fields for name in names.split()]
    return type(c_name, (Struct,), {"c_name": c_name, "_fields_": each})


# Equilibria: double precision

AssemblyStruct = _struct(
    "assembly",
    (ctypes.c_int32, "nodes bars bends panels cylinders floats springs grounds"),
    (INTEGERS, "bar_ends bend_nodes panel_corners cylinder_ends float_nodes"),
    (INTEGERS, "spring_nodes ground_nodes"),
    (DOUBLES, "weight bar_length bar_stiffness bar_least"),
    (DOUBLES, "bend_stiffness bend_plane bend_turn panel_share panel_outline"),
    (DOUBLES, "cylinder_width float_stiffness float_draft float_height"),
    (DOUBLES, "spring_place spring_stiffness spring_preload ground_stiffness"),
    (ctypes.c_double, "ground_level"),
)
FlowStruct = _struct("flow", (DOUBLES, "direction panel pipe_direction pipe_pressure"))
RelaxationStruct = _struct(
    "relaxation",
    (DOUBLES, "inverse_mass soft_rate true_rate"),
    (ctypes.c_double, "tolerance progress most_damping"),
    (ctypes.c_int32, "patience steps rounds"),
)
RelaxingStruct = _struct(
    "relaxing", (DOUBLES, "position velocity carried damping best stalled rounds residual")
)
PatternStruct = _struct(
    "pattern",
    (INTEGERS, "row diagonal column order bars bends panels cylinders floats springs grounds"),
)
BalanceStruct = _struct(
    "balance",
    (DOUBLES, "free true_rate"),
    (ctypes.c_double, "tolerance reach least_barrier least_shift most_shift"),
    (ctypes.c_int32, "iterations"),
)
BalancingStruct = _struct(
    "balancing", (DOUBLES, "position tension barrier shift moved sign iterations residual")
)
BenchStruct = _struct(
    "bench", (DOUBLES, "truth force step zero tension bar blocks"), (INTEGERS, "place")
)

# The march: single precision

BodyStruct = _struct(
    "body",
    (ctypes.c_int32, "nodes bars bends panels cylinders floats springs grounds lines"),
    (ctypes.c_int32, "buoys twines slenders cage_nodes"),
    (INTEGERS, "bar_ends bend_nodes panel_corners cylinder_ends float_nodes"),
    (INTEGERS, "spring_nodes ground_nodes line_bars line_floats slender_nodes"),
    (INTEGERS, "cylinder_body twine_bars anchor_bars"),
    (FLOATS, "weight mass water_mass place chord slender_tangent slender_mass"),
    (FLOATS, "bar_length bar_rate bar_damping bar_least"),
    (FLOATS, "bend_stiffness bend_plane bend_turn panel_share panel_outline panel_mass"),
    (FLOATS, "cylinder_drag cylinder_skin"),
    (FLOATS, "float_stiffness float_draft float_height"),
    (FLOATS, "spring_place spring_stiffness spring_preload spring_damping"),
    (FLOATS, "ground_stiffness cylinder_series"),
    (ctypes.c_float, "ground_level"),
)
NettingStruct = _struct("netting", (ctypes.c_int32, "kind"), (FLOATS, "law drag_factor wake all"))
SeaStruct = _struct(
    "sea",
    (ctypes.c_int32, "components levels spread"),
    (INTEGERS, "shallow"),
    (DOUBLES, "turns turns_per_second"),
    (FLOATS, "number toward_x toward_y amplitude speed reach floor bounce"),
    (FLOATS, "level_z current"),
    (ctypes.c_float, "depth"),
)
ScheduleStruct = _struct(
    "schedule",
    (ctypes.c_double, "time_step ramp"),
    (ctypes.c_int64, "first refreshes count_from sample_every"),
    (ctypes.c_int32, "steps hold"),
)
StateStruct = _struct(
    "state",
    (FLOATS, "position rest velocity water slope current relative force base held"),
    (FLOATS, "drag elevation rise panel_current panel_factor panel_drag panel_lift lost_at"),
)
RecordStruct = _struct(
    "record",
    (DOUBLES, "node_sum node_square"),
    (FLOATS, "node_least node_most"),
    (DOUBLES, "line_sum line_square"),
    (FLOATS, "line_least line_most"),
    (DOUBLES, "load_sum load_square"),
    (FLOATS, "load_least load_most"),
    (LONGS, "counted sampled"),
    (DOUBLES, "twine_sum"),
    (FLOATS, "twine_most twine_slack"),
    (DOUBLES, "anchor_sum"),
    (FLOATS, "uplift_most"),
    (FLOATS, "positions elevations loads tensions"),
)

STRUCTS = tuple(Struct.__subclasses__())  # all structs that Python fills for the kernel
