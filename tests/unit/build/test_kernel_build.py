"""The build hook makes libraries that load anywhere and leave their process alone."""

import ctypes
import importlib.util
import math
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest
from hatchling.build import get_requires_for_build_editable, get_requires_for_build_wheel

from seacage.dynamics._kernel._library import LEVELS

KERNEL = """
#include <math.h>
double norm(double x, double y) { return sqrt(x * x + y * y); }
int is_infinite(double x) { return isinf(x) != 0; }
int is_below(float x, float y) { return x < y; }
"""
SECOND = """
#include "_step.h"
/* What rounding cut off a sum is kept: the optimiser may not say it is zero. */
float cut_off(float sum, float add)
{
    const float now = sum + add;
    return STEP * add - (now - sum);
}
"""


@pytest.fixture(scope="module")
def build(request: pytest.FixtureRequest) -> ModuleType:
    """The hook's own file, which lies beside `pyproject.toml`."""
    place = request.config.rootpath / "hatch_build.py"
    spec = importlib.util.spec_from_file_location("hatch_build", place)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def library(build: ModuleType, tmp_path: Path) -> Path:
    """A small kernel, built for the plainest machine."""
    compiler = build.system_compiler()
    if compiler is None:
        pytest.skip("needs a C compiler")
    source = tmp_path / "_kernel.c"
    source.write_text(KERNEL)
    source.with_name("_second.c").write_text(SECOND)
    source.with_name("_step.h").write_text("#define STEP 1.0f\n")
    return build.build(compiler, source, build.HOST.instruction_sets[0])


@pytest.fixture
def no_compiler(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A machine where PATH and CC name no compiler."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)


def test_a_built_library_computes(library: Path) -> None:
    norm = ctypes.CDLL(str(library)).norm
    norm.restype, norm.argtypes = ctypes.c_double, (ctypes.c_double, ctypes.c_double)
    assert norm(3.0, 4.0) == 5.0


def test_a_built_library_still_knows_what_is_infinite(library: Path) -> None:
    is_infinite = ctypes.CDLL(str(library)).is_infinite
    is_infinite.argtypes = (ctypes.c_double,)
    assert is_infinite(math.inf)
    assert not is_infinite(1e300)


def test_a_built_library_still_knows_what_is_no_number(library: Path) -> None:
    is_below = ctypes.CDLL(str(library)).is_below
    is_below.argtypes = (ctypes.c_float, ctypes.c_float)
    assert is_below(1.0, 2.0)
    assert not is_below(math.nan, 2.0)
    assert not is_below(2.0, math.nan)


def test_every_c_file_beside_the_source_is_in_the_library_and_sums_stay_as_written(
    library: Path,
) -> None:
    cut_off = ctypes.CDLL(str(library)).cut_off
    cut_off.restype, cut_off.argtypes = ctypes.c_float, (ctypes.c_float, ctypes.c_float)
    assert cut_off(1.0, 2.0**-30) == 2.0**-30
    assert cut_off(1.0, 0.5) == 0.0


def test_a_change_in_any_source_of_the_kernel_builds_it_again(
    pytestconfig: pytest.Config,
) -> None:
    root = pytestconfig.rootpath
    rules = subprocess.run(
        ["make", "-p", "-n", "help"], cwd=root, check=True, capture_output=True, text=True
    )
    reads = next(
        line for line in rules.stdout.splitlines() if line.startswith(".venv/.project: ")
    ).split()
    room = root / "src" / "seacage" / "dynamics" / "_kernel"
    sources = [p for p in room.iterdir() if p.suffix in {".c", ".h"}]
    assert len(sources) > 1
    assert {p.relative_to(root).as_posix() for p in sources} <= set(reads)


def test_loading_a_library_keeps_denormals_in_the_rest_of_the_process(library: Path) -> None:
    halve = f"import ctypes; ctypes.CDLL({str(library)!r}); print(float('1e-320') * 0.5)"
    result = subprocess.run(
        [sys.executable, "-c", halve], check=True, capture_output=True, text=True
    )
    assert float(result.stdout) > 0.0


def test_a_build_leaves_nothing_but_the_library(library: Path) -> None:
    assert {path.name for path in library.parent.iterdir()} == {
        *("_kernel.c", "_second.c", "_step.h"),
        library.name,
    }


def test_a_kernel_that_does_not_compile_is_refused_with_the_words_of_the_compiler(
    build: ModuleType, library: Path
) -> None:
    source = library.with_name("_kernel.c")
    source.write_text("not C")
    with pytest.raises(build.CompileError, match=r"failed with code 1[\s\S]*error"):
        build.build(build.system_compiler(), source, build.HOST.instruction_sets[0])


@pytest.mark.usefixtures("no_compiler")
@pytest.mark.parametrize(
    "requires", [get_requires_for_build_wheel, get_requires_for_build_editable]
)
def test_a_machine_without_a_compiler_gets_one_from_pypi(
    requires, build: ModuleType, monkeypatch: pytest.MonkeyPatch, pytestconfig: pytest.Config
) -> None:
    monkeypatch.chdir(pytestconfig.rootpath)
    assert build.ZIGLANG in requires()


def test_a_compiler_named_in_cc_is_taken_at_its_word(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CC", "ccache clang")
    assert build.system_compiler() == ["ccache", "clang"]


def test_zig_gets_the_instruction_set_in_its_own_spelling(build: ModuleType) -> None:
    assert build.flags_of(["gcc"], "x86-64-v3") == ["-march=x86-64-v3"]
    zig = [sys.executable, "-m", "ziglang", "cc"]
    assert build.flags_of(zig, "x86-64-v3") == ["-mcpu=x86_64_v3"]


def test_another_machines_wheel_is_compiled_by_zig_also_where_cc_names_a_compiler(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch, pytestconfig: pytest.Config
) -> None:
    monkeypatch.chdir(pytestconfig.rootpath)
    monkeypatch.setenv("CC", "ccache clang")
    monkeypatch.setenv("SEACAGE_TARGET", "macos-arm64")
    assert build.compiler_for(build.chosen_target())[-2:] == ["-target", "aarch64-macos.11.0"]
    assert build.ZIGLANG in get_requires_for_build_wheel()


def test_an_unknown_target_is_refused_with_all_that_there_are(
    build: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SEACAGE_TARGET", "amiga")
    with pytest.raises(SystemExit, match=r"'amiga' is no target: set it to linux-x86_64, .*unset"):
        build.chosen_target()


def test_each_target_has_an_instruction_set_that_the_package_loads(build: ModuleType) -> None:
    for target in build.TARGETS.values():
        assert set(target.instruction_sets) <= set(LEVELS)
        assert target.suffix in build.LINK
