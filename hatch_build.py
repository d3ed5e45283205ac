"""Builds the time-stepping kernel, one shared library per instruction set, and the page.

The kernel is plain C99 that ctypes loads: no Python headers are needed, and one
wheel serves every Python of a platform. On x86-64 it is built three times, and
`seacage.dynamics` loads the best that the machine can run. Where no C compiler
works, the build asks for the one in PyPI's `ziglang`. The page is built by `web/build.py`
where its sources are newer than what was built of them; where it cannot be, the rest is
installed all the same.
"""

import importlib.util
import os
import platform
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from types import ModuleType

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

KERNEL = Path("src", "seacage", "dynamics", "_kernel")
PAGE = Path("src", "seacage", "service", "page")
ZIGLANG = "ziglang>=0.13"
# Kept out of -ffast-math: infinities, for they mark slack bars; and sums as they are written,
# for compensated ones would be optimised away.
FLAGS = (
    "-std=c99 -O3 -ffast-math -fno-finite-math-only -fno-associative-math -fopenmp-simd -fPIC -Wall"
).split()
# Linked apart from -ffast-math, which would make older GCCs add start-up code that flushes
# denormals to zero in the whole process, NumPy's too; and without the compiler's own runtime,
# which the kernel does not need and zig would first build for half a minute.
LINK = "-shared -nostdlib -lm -lc".split()
PROBE = "#include <math.h>\ndouble probe(double x) { return sqrt(x); }\n"
SUFFIX = {"Darwin": ".dylib", "Windows": ".dll"}.get(platform.system(), ".so")
TARGETS = (
    ("x86-64-v2", "x86-64-v3", "x86-64-v4")
    if platform.machine().lower() in {"x86_64", "amd64"}
    else ("native",)
)


class CompileError(Exception):
    """The compiler refused the kernel."""


class Build(BuildHookInterface):
    """Puts kernel and page into the source tree, where editable installs find them too."""

    def dependencies(self) -> list[str]:
        """Ask PyPI for a compiler and for Node only where the machine has none that works."""
        page = page_build(self.root)
        compiler = [] if system_compiler() else [ZIGLANG]
        return compiler + ([] if page.is_current() or page.system_node() else [page.NODE_WHEEL])

    def initialize(self, version: str, build_data: dict[str, object]) -> None:  # noqa: ARG002
        """Compile for every target, build the page, mark the wheel as made for this platform."""
        compiler = system_compiler() or [sys.executable, "-m", "ziglang", "cc"]
        source = Path(self.root, KERNEL, "_kernel.c")
        with ThreadPoolExecutor() as pool:
            libraries = list(pool.map(lambda target: build(compiler, source, target), TARGETS))
        build_data["pure_python"] = False
        build_data["tag"] = platform_tag()
        build_data["artifacts"] = [
            *(library.relative_to(self.root).as_posix() for library in libraries),
            f"{PAGE.as_posix()}/**",
        ]
        build_page(self.root)


def page_build(root: str) -> ModuleType:
    """`web/build.py`, which is no module of a package."""
    spec = importlib.util.spec_from_file_location("page_build", Path(root, "web", "build.py"))
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def build_page(root: str) -> None:
    """Build the page unless it is there; without it the service still works, and says so."""
    page = page_build(root)
    if page.is_current():
        return
    try:
        page.build()
    except page.PageError as fault:
        sys.stderr.write(f"seacage is installed without its page. {fault}\n")


def system_compiler() -> list[str] | None:
    """`$CC`, taken at its word; else the first of cc, gcc and clang that can build a library.

    Being on PATH is not enough: Debian's gcc may come without the C headers, and
    an old one does not know the instruction sets by name.
    """
    if chosen := os.environ.get("CC"):
        return shlex.split(chosen)
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder, "_kernel.c")
        source.write_text(PROBE)
        for name in ("cc", "gcc", "clang"):
            with suppress(OSError, CompileError):
                build([name], source, TARGETS[-1])
                return [name]
    return None


def build(compiler: list[str], source: Path, target: str) -> Path:
    """One library of all C files beside the source; replaced at once, as it may be in use."""
    library = source.with_name(f"_kernel_{target}{SUFFIX}")
    with tempfile.TemporaryDirectory(dir=source.parent, prefix=".build-") as folder:
        linked, objects = Path(folder, "kernel"), list[Path]()
        chosen = instruction_set(compiler, target)
        for unit in sorted(source.parent.glob("*.c")):
            objects.append(Path(folder, f"{unit.stem}.o"))
            run([*compiler, *FLAGS, *chosen, "-c", unit, "-o", objects[-1]], folder)
        run([*compiler, *objects, "-o", linked, *LINK], folder)
        linked.replace(library)
    return library


def instruction_set(compiler: list[str], target: str) -> list[str]:
    """The flags that choose it, which zig spells in its own way."""
    if target == "native":
        return []
    is_zig = any("zig" in word for word in compiler)
    chosen = f"-mcpu={target.replace('-', '_')}" if is_zig else f"-march={target}"
    return [chosen, "-mprefer-vector-width=512"] if target.endswith("v4") else [chosen]


def run(command: list[str | Path], folder: str) -> None:
    """Run the compiler, zig's caches in the given folder."""
    caches = {"ZIG_GLOBAL_CACHE_DIR": folder, "ZIG_LOCAL_CACHE_DIR": folder}
    environment = os.environ | caches
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise CompileError(
            f"{' '.join(map(str, command))}\nfailed with code {done.returncode}; mend what it "
            f"says, or name another C compiler in CC:\n{done.stderr}"
        )
    sys.stderr.write(done.stderr)


def platform_tag() -> str:
    """Any Python 3 of this platform; `manylinux` would take a build on an old system."""
    from packaging.tags import sys_tags

    tags = (tag.platform for tag in sys_tags())
    here = next(tag for tag in tags if "manylinux" not in tag and "musllinux" not in tag)
    return f"py3-none-{here}"
