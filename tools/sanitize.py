"""Run the compiled kernel under the compiler's address and undefined-behaviour sanitizers.

First its property tests, then random inputs: structures of valid indices whose numbers are
plain, huge, tiny, infinite or not numbers at all, through every entry point, a few steps each.
The sanitizers end the process at the first access outside an array, at arithmetic that C does
not define and at a number that does not fit an integer.

    python tools/sanitize.py --inputs 100000
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
KERNEL = ROOT / "src" / "seacage" / "dynamics" / "_kernel"
TESTS = ("tests/properties/test_kernel.py", "tests/properties/test_march.py")
FLAGS = (
    "-std=c99 -O1 -g -fno-omit-frame-pointer -fopenmp-simd -fPIC -shared "
    "-fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all"
).split()
COMPILERS = (("gcc", "libasan.so"), ("clang", "libclang_rt.asan-x86_64.so"))


# The parent: builds the library, then runs the rest beside the sanitizers' own runtime


def main() -> int:
    """Build, then run tests and inputs in processes that the sanitizers watch."""
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--inputs", type=int, default=3000, help="random ones (%(default)s)")
    arguments.add_argument("--seed", type=int, default=0, help="of the first (%(default)s)")
    arguments.add_argument("--library", type=Path, help=argparse.SUPPRESS)
    arguments.add_argument("--tests", action="store_true", help=argparse.SUPPRESS)
    arguments.add_argument("--at", type=Path, help=argparse.SUPPRESS)
    options = arguments.parse_args()
    if options.library is None:
        return watch(sys.argv[1:])
    if options.tests:
        return run_tests(options.library)
    return run_inputs(
        options.library, range(options.seed, options.seed + options.inputs), options.at
    )


def watch(arguments: list[str]) -> int:
    """Both halves, each in its own process; the first that fails ends it."""
    with tempfile.TemporaryDirectory() as folder:
        found = built(Path(folder, "kernel.so"))
        if found is None:
            sys.stderr.write(
                "sanitize: neither gcc nor clang builds a library with sanitizers here. "
                "Install one with: apt-get install -y gcc libc6-dev\n"
            )
            return 1
        library, runtime = found
        environment = os.environ | {
            "LD_PRELOAD": str(runtime),
            # Python keeps its memory to the end, which is no leak
            "ASAN_OPTIONS": "detect_leaks=0",
            "UBSAN_OPTIONS": "print_stacktrace=1",
            "OMP_NUM_THREADS": "1",
        }
        at = Path(folder, "at")
        for half in (["--tests"], ["--at", at, *arguments]):
            command = [sys.executable, __file__, "--library", library, *half]
            done = subprocess.run(command, cwd=ROOT, env=environment, check=False)
            if done.returncode:
                if at.exists():
                    seed = at.read_text()
                    sys.stderr.write(f"sanitize: that was --seed {seed} --inputs 1\n")
                return 1
    return 0


def built(library: Path) -> tuple[Path, Path] | None:
    """The library and the runtime that must be loaded before it, by the first compiler able."""
    for compiler, runtime in COMPILERS:
        command = [compiler, *FLAGS, *sorted(KERNEL.glob("*.c")), "-o", library, "-lm"]
        query = [compiler, f"-print-file-name={runtime}"]
        try:
            subprocess.run(command, check=True, capture_output=True)
            result = subprocess.run(query, check=True, capture_output=True, text=True)
        except (OSError, subprocess.CalledProcessError) as reason:
            words = getattr(reason, "stderr", None) or str(reason).encode()
            sys.stderr.write(f"{compiler}: {words.decode()}\n")
            continue
        if Path(result.stdout.strip()).is_absolute():
            return library, Path(result.stdout.strip()).resolve()
    return None


# The child: everything below runs with the sanitized library


def loads(library: Path) -> None:
    """Let whoever asks for the kernel get this library."""
    from seacage.dynamics._kernel import _library

    plain = _library.Kernel
    _library.Kernel = lambda _path: plain(library)  # type: ignore[assignment,misc]


class Plugin:
    """Loads the library once the tests' configuration has set up the checks of shapes."""

    def __init__(self, library: Path) -> None:
        self.library = library

    def pytest_sessionstart(self) -> None:
        """See the class."""
        loads(self.library)


def run_tests(library: Path) -> int:
    """The tests that hold the kernel to its definition."""
    import pytest

    # slower than elsewhere; uncaptured, for a report of the sanitizers ends the process
    options = ["-n", "0", "-q", "-s", "--timeout", "600", "-p", "no:cacheprovider"]
    options += ["--hypothesis-seed", "0"]  # the same inputs each time, as everything here
    return int(pytest.main([*options, *TESTS], plugins=[Plugin(library)]))


def run_inputs(library: Path, seeds: range, at: Path) -> int:
    """Random inputs, each from its own seed, so that one that fails can be run alone."""
    loads(library)
    from _kernel_inputs import march, settle

    from seacage.dynamics._kernel._library import kernel

    start = time.monotonic()
    with at.open("w") as file:
        for done, seed in enumerate(seeds, start=1):
            # written before, for a report of the sanitizers ends the process
            os.pwrite(file.fileno(), str(seed).encode(), 0)
            with np.errstate(all="ignore"):
                (march, settle)[seed % 2](kernel().library, np.random.default_rng(seed))
            if done % max(1, len(seeds) // 5) == 0:
                took = time.monotonic() - start
                sys.stdout.write(f"{done} random inputs, {took:.0f} s, no report\n")
                sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
