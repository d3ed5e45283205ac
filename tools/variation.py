"""Lists the variations under which `make test` has to pass; `.ci/run` takes one in turn.

    python tools/variation.py        all that this machine can run, a line each
    python tools/variation.py 1234   the one of turn 1234, as settings for `env`

A test that passes on the machine of whoever wrote it may compare rounded numbers too closely:
another processor, another number of threads and another order show that.
"""

import sys
from collections.abc import Sequence

CORETYPES = {"Prescott": 2, "Nehalem": 2, "Haswell": 3, "Zen": 3, "SkylakeX": 4}
"""OpenBLAS's sets of routines, and the level of x86-64 that a processor needs for each."""
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def variations(built: Sequence[str], level: int) -> list[str]:
    """The settings of each variation; level 0 is a processor other than x86-64.

    Parameters
    ----------
    built
        Names of the kernels that were built.
    level
        Of x86-64, that the processor can run; 0 for another processor.
    """
    return [
        *(f"OPENBLAS_CORETYPE={name}" for name, needs in CORETYPES.items() if needs <= level),
        *(f"SEACAGE_KERNEL={name}" for name in built if "x86" < name <= f"x86-64-v{level}"),
        " ".join(f"{name}=1" for name in THREADS),
        # One worker: two with two threads each would wait for one another on two cores.
        " ".join([*(f"{name}=2" for name in THREADS), "WORKERS=1"]),
        "SEACAGE_ORDER=random",
    ]


def in_turn(all_of_them: Sequence[str], turn: int) -> str:
    """The variation of this turn; a random order has the turn as its seed."""
    return all_of_them[turn % len(all_of_them)].replace("=random", f"={turn}")


def main(arguments: list[str]) -> None:
    """Print all, or the one of the turn that is given."""
    from seacage.dynamics._kernel._library import available

    found = variations(*available())
    print(in_turn(found, int(arguments[0])) if arguments else "\n".join(found))


if __name__ == "__main__":
    main(sys.argv[1:])
