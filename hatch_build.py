"""Builds the time-stepping kernel, one shared library per instruction set, and the page.

The kernel is plain C99 that ctypes loads: no Python headers are needed, and one
wheel serves every Python of a platform. On x86-64 it is built three times, and
`seacage.dynamics` loads the best that the machine can run. Where no C compiler
works, the build asks for the one in PyPI's `ziglang`. The page is built by `web/build.py`
where its sources are newer than what was built of them; where it cannot be, the rest is
installed all the same.

`SEACAGE_TARGET=linux-aarch64`, or another of `TARGETS`, makes the wheel of that kind of machine
on any other: zig compiles for it, outside the tree, and a wheel without its page is refused.
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
from dataclasses import dataclass
from functools import partial
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
# which the kernel does not need and zig would first build for half a minute. On Windows alone it
# needs what grows the stack: of zig's runtimes the small one has that, and the other takes minutes.
LINK = {
    ".so": "-shared -nostdlib -lm -lc".split(),
    ".dylib": "-shared -nostdlib -lm -lc -Wl,-install_name,@rpath/kernel.dylib".split(),
    ".dll": "-shared -nostdlib -lgcc -Wl,--no-entry -lapi-ms-win-crt-math-l1-1-0".split(),
}
PROBE = "#include <math.h>\ndouble probe(double x) { return sqrt(x); }\n"
X86 = ("x86-64-v2", "x86-64-v3", "x86-64-v4")
PLAIN = ("native",)


@dataclass(frozen=True)
class Target:
    """A kind of machine that a wheel is made for."""

    triple: str  # its name for zig; empty for the machine that builds
    instruction_sets: tuple[str, ...]
    suffix: str  # of its libraries
    tag: str  # the wheel's platform; empty for the machine that builds


HOST = Target(
    "",
    X86 if platform.machine().lower() in {"x86_64", "amd64"} else PLAIN,
    {"Darwin": ".dylib", "Windows": ".dll"}.get(platform.system(), ".so"),
    "",
)
TARGETS = {
    "linux-x86_64": Target(
        "x86_64-linux-gnu.2.17", X86, ".so", "manylinux2014_x86_64.manylinux_2_17_x86_64"
    ),
    "linux-aarch64": Target(
        "aarch64-linux-gnu.2.17", PLAIN, ".so", "manylinux2014_aarch64.manylinux_2_17_aarch64"
    ),
    "musl-x86_64": Target("x86_64-linux-musl", X86, ".so", "musllinux_1_2_x86_64"),
    "musl-aarch64": Target("aarch64-linux-musl", PLAIN, ".so", "musllinux_1_2_aarch64"),
    "macos-x86_64": Target("x86_64-macos.11.0", X86, ".dylib", "macosx_11_0_x86_64"),
    "macos-arm64": Target("aarch64-macos.11.0", PLAIN, ".dylib", "macosx_11_0_arm64"),
    "windows-x86_64": Target("x86_64-windows-gnu", X86, ".dll", "win_amd64"),
}


class CompileError(Exception):
    """The compiler refused the kernel."""


class Build(BuildHookInterface):
    """Puts kernel and page into the source tree, where editable installs find them too."""

    def dependencies(self) -> list[str]:
        """Ask PyPI for a compiler and for Node only where the machine has none that works."""
        page = page_build(self.root)
        compiler = [] if compiler_for(chosen_target())[0] != sys.executable else [ZIGLANG]
        return compiler + ([] if page.is_current() or page.system_node() else [page.NODE_WHEEL])

    def initialize(self, version: str, build_data: dict[str, object]) -> None:  # noqa: ARG002
        """Compile every instruction set, build the page, mark the wheel as made for its target."""
        target, kernel = chosen_target(), Path(self.root, KERNEL)
        self._outside = tempfile.TemporaryDirectory()
        into = Path(self._outside.name) if target.triple else kernel
        compile_for = partial(
            build, compiler_for(target), kernel / "_kernel.c", target=target, into=into
        )
        with ThreadPoolExecutor() as pool:
            libraries = list(pool.map(compile_for, target.instruction_sets))
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{target.tag or platform_tag()}"
        build_data["artifacts"] = [f"{PAGE.as_posix()}/**"]
        if target.triple:
            inside = KERNEL.relative_to("src")
            build_data["force_include"] = {
                str(library): (inside / library.name).as_posix() for library in libraries
            }
        else:
            build_data["artifacts"] += [(KERNEL / each.name).as_posix() for each in libraries]
        build_page(self.root, needed=bool(target.triple))

    def finalize(self, version: str, build_data: dict[str, object], artifact_path: str) -> None:  # noqa: ARG002
        """Remove the libraries of another machine, which the wheel has now."""
        self._outside.cleanup()


def chosen_target() -> Target:
    """The target that `SEACAGE_TARGET` names, else the machine that builds."""
    name = os.environ.get("SEACAGE_TARGET", "")
    if name and name not in TARGETS:
        sys.exit(
            f"SEACAGE_TARGET = {name!r} is no target: set it to {', '.join(TARGETS)}, or unset it "
            "for this machine."
        )
    return TARGETS[name] if name else HOST


def compiler_for(target: Target) -> list[str]:
    """The C compiler for a target: zig for another machine, and where this one has none."""
    zig = [sys.executable, "-m", "ziglang", "cc"]
    if target.triple:
        return [*zig, "-target", target.triple]
    return system_compiler() or zig


def page_build(root: str) -> ModuleType:
    """`web/build.py`, which is no module of a package."""
    spec = importlib.util.spec_from_file_location("page_build", Path(root, "web", "build.py"))
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def build_page(root: str, *, needed: bool = False) -> None:
    """Build the page unless it is there; without it the service still works, and says so.

    ``needed``: whether to fail without it.
    """
    page = page_build(root)
    if page.is_current():
        return
    try:
        page.build()
    except page.PageError as fault:
        if needed:
            raise
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
                build([name], source, HOST.instruction_sets[-1])
                return [name]
    return None


def build(
    compiler: list[str],
    source: Path,
    instruction_set: str,
    *,
    target: Target = HOST,
    into: Path | None = None,
) -> Path:
    """One library of all C files beside the source; replaced at once, as it may be in use.

    ``into``: the folder for it; beside the source where there is none.
    """
    library = (into or source.parent) / f"_kernel_{instruction_set}{target.suffix}"
    with tempfile.TemporaryDirectory(dir=library.parent, prefix=".build-") as folder:
        linked, objects = Path(folder, "kernel"), list[Path]()
        flags = [*FLAGS, *flags_of(compiler, instruction_set)]
        for unit in sorted(source.parent.glob("*.c")):
            objects.append(Path(folder, f"{unit.stem}.o"))
            run([*compiler, *flags, "-c", unit, "-o", objects[-1]], folder)
        run([*compiler, *objects, "-o", linked, *link_flags(target)], folder)
        linked.replace(library)
    return library


def flags_of(compiler: list[str], instruction_set: str) -> list[str]:
    """The flags that choose an instruction set, which zig spells in its own way."""
    if instruction_set == "native":
        return []
    is_zig = any("zig" in word for word in compiler)
    name = instruction_set.replace("-", "_")
    chosen = f"-mcpu={name}" if is_zig else f"-march={instruction_set}"
    return [chosen, "-mprefer-vector-width=512"] if instruction_set.endswith("v4") else [chosen]


def link_flags(target: Target) -> list[str]:
    """Those of its libraries, stripped for another machine.

    musl has no name that all systems share, and is in every process that loads the kernel.
    """
    flags = LINK[target.suffix] + (["-s"] if target.triple else [])
    return [each for each in flags if "musl" not in target.triple or not each.startswith("-l")]


def run(command: list[str | Path], folder: str) -> None:
    """Run the compiler, zig's caches in the given folder unless the environment names others."""
    caches = {"ZIG_GLOBAL_CACHE_DIR": folder, "ZIG_LOCAL_CACHE_DIR": folder}
    environment = caches | os.environ
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise CompileError(
            f"{' '.join(map(str, command))}\nfailed with code {done.returncode}; mend what it "
            f"says, or name another C compiler in CC:\n{done.stderr}"
        )
    sys.stderr.write(done.stderr)


def platform_tag() -> str:
    """Platform of this machine alone; only a target's compiler serves `manylinux`."""
    from packaging.tags import sys_tags

    tags = (tag.platform for tag in sys_tags())
    return next(tag for tag in tags if "manylinux" not in tag and "musllinux" not in tag)
