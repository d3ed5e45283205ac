"""Records what this machine's kernel answers, for `play_kernel.c` to compare another one with.

A small cage settles in a current, and moves in waves: the first call of Newton's method and one,
cut short, of the march go into the file, with every array before and after.

    python tools/record_kernel.py calls.bin
"""

import ctypes
import struct
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

from seacage.cage import Cage
from seacage.dynamics import settle, simulate
from seacage.dynamics._kernel._library import kernel
from seacage.dynamics._kernel._structs import Struct
from seacage.ocean import SeaState

CALLS = ("seacage_balance", "seacage_march")
REFRESHES = 40  # of the water, in the march: seconds in an emulator


def record(path: Path) -> None:
    """Write both calls."""
    cage = Cage.named("ace").altered(mesh={"spokes": 8})
    sea = SeaState(current_speed=0.5, current_to=40.0, hs=1.5, tp=7.0, wave_from=220.0)
    with path.open("wb") as file, watch(file):
        settle(cage, SeaState(current_speed=0.5, current_to=40.0))
        simulate(cage, sea, duration=1.0)


@contextmanager
def watch(file: BinaryIO) -> Iterator[None]:
    """Write the first of each call that the kernel gets."""
    library, plain = kernel().library, {name: getattr(kernel().library, name) for name in CALLS}
    written = set[str]()
    for name, function in plain.items():
        setattr(library, name, recorder(file, name, function, written))
    try:
        yield
    finally:
        for name, function in plain.items():
            setattr(library, name, function)


def recorder(
    file: BinaryIO, name: str, function: Callable[..., None], written: set[str]
) -> Callable[..., None]:
    """The kernel's function, which writes its first call."""

    def call(*arguments: Any) -> None:
        structs: list[Struct] = [argument._obj for argument in arguments]
        if name == "seacage_march":
            schedule = next(one for one in structs if one.c_name == "schedule")
            schedule.refreshes = min(REFRESHES, schedule.refreshes)  # pyright: ignore[reportAttributeAccessIssue]
        numbers = [bytes(one) for one in structs]
        before = [{key: each.tobytes() for key, each in one.arrays.items()} for one in structs]
        function(*arguments)
        if name not in written:
            written.add(name)
            file.write(struct.pack("32s", name.encode()))
            for one, plain, arrays in zip(structs, numbers, before, strict=True):
                write_struct(file, one, plain, arrays)

    return call


def write_struct(file: BinaryIO, one: Struct, plain: bytes, before: dict[str, bytes]) -> None:
    """A struct's numbers, and each of its arrays before and after."""
    size, arrays = ctypes.sizeof(one), one.arrays
    file.write(struct.pack("<32sii", one.c_name.encode(), size, len(arrays)) + plain)
    for name, array in arrays.items():
        kind = ord({"f4": "f", "f8": "d", "i4": "i", "i8": "q"}[array.dtype.str[1:]])
        offset = getattr(type(one), name).offset
        file.write(struct.pack("<32siiq", name.encode(), offset, kind, array.nbytes))
        file.write(before[name] + array.tobytes())


if __name__ == "__main__":
    record(Path(sys.argv[1]))
