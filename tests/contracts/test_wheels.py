"""Wheels for other machines: what lies in them, and what their kernels answer."""

import base64
import csv
import hashlib
import os
import subprocess
import sys
import venv
from io import StringIO
from pathlib import Path
from zipfile import ZipFile

import pytest

from seacage.dynamics._kernel._library import LEVELS, available
from tools.record_kernel import record

ROOT = Path(__file__).parents[2]
X86 = ["x86-64-v2", "x86-64-v3", "x86-64-v4"]
WHEELS = {
    "linux-x86_64": ("manylinux_2_17_x86_64", ".so", X86, b"\x7fELF"),
    "linux-aarch64": ("manylinux_2_17_aarch64", ".so", ["native"], b"\x7fELF"),
    "musl-x86_64": ("musllinux_1_2_x86_64", ".so", X86, b"\x7fELF"),
    "macos-arm64": ("macosx_11_0_arm64", ".dylib", ["native"], b"\xcf\xfa\xed\xfe"),
    "windows-x86_64": ("win_amd64", ".dll", X86, b"MZ"),
}
"""By target: its tag, its libraries' suffix, their names, and how they begin."""

SIGNATURE = b"\xfa\xde\x0c\xc0"  # of macOS, which loads no library of arm64 without one
# Between compilers and instruction sets: how sums and fused products are rounded. Newton's method
# is in double, the march in single precision, where a place 593 m away has steps of 6e-5 m.
NEAR = {
    ("seacage_balance", "balancing", "position"): 1e-8,
    ("seacage_balance", "balancing", "tension"): 1e-4,
    ("seacage_march", "state", "position"): 2e-4,
    ("seacage_march", "state", "water"): 1e-6,
}

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def tools(tmp_path_factory):
    """A program of Python with the tools of `make wheels`, all with one cache of the compiler's."""
    folder = tmp_path_factory.mktemp("tools")
    venv.create(folder / "venv", with_pip=True)
    caches = {"ZIG_GLOBAL_CACHE_DIR": folder / "zig", "ZIG_LOCAL_CACHE_DIR": folder / "zig"}

    def run(*words, **environment):
        return subprocess.run(
            [folder / "venv/bin/python", "-m", *words],
            env=os.environ | caches | environment,
            cwd=ROOT,
            check=True,
            capture_output=True,
            text=True,
        ).stdout

    run("pip", "install", "--quiet", "--requirement", ROOT / "tools/wheels.txt")
    return run


@pytest.fixture(scope="module")
def wheel(tmp_path_factory, tools, built_page):
    """Makes a target's wheel, once."""
    made = {}

    def make(target: str) -> Path:
        if target not in made:
            folder = tmp_path_factory.mktemp(target)
            tools("hatchling", "build", "-t", "wheel", "-d", folder, SEACAGE_TARGET=target)
            (made[target],) = folder.glob("*.whl")
        return made[target]

    return make


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    """Calls of this machine's kernel, to compare others with."""
    path = tmp_path_factory.mktemp("calls") / "calls.bin"
    record(path)
    return path


@pytest.fixture
def play(wheel, tools, calls, tmp_path):
    """Plays the calls with a wheel's kernel; returns the largest difference by call and array."""

    def play(target, triple, name, *runner):
        with ZipFile(wheel(target)) as file:
            kernel = file.extract(f"seacage/dynamics/_kernel/_kernel_{name}.so", tmp_path)
        player, source = tmp_path / "player", ROOT / "tools/play_kernel.c"
        tools("ziglang", "cc", "-target", triple, "-O1", source, "-o", player)
        words = [*runner, player, calls, kernel]
        ran = subprocess.run(words, check=True, capture_output=True, text=True)
        rows = [line.split() for line in ran.stdout.splitlines()]
        return {tuple(row[:3]): float(row[3]) for row in rows}

    return play


@pytest.mark.parametrize("target", WHEELS)
def test_a_wheel_holds_its_own_libraries_stripped_and_without_a_path(wheel, target):
    tag, suffix, names, head = WHEELS[target]
    path = wheel(target)
    assert tag in path.name
    assert path.stat().st_size < 4e6, "an index takes more, but a boat's line does not"
    with ZipFile(path) as file:
        listed = file.namelist()
        ends = (".so", ".dll", ".dylib", ".lib", ".pdb", ".exe")
        room = "seacage/dynamics/_kernel/_kernel_"
        assert {n for n in listed if n.endswith(ends)} == {f"{room}{n}{suffix}" for n in names}
        assert "seacage/service/page/index.html" in listed
        for name in names:
            content = file.read(f"{room}{name}{suffix}")
            assert content.startswith(head)
            for trace in (str(ROOT).encode(), b"/tmp", b"/home", b"/build", b".debug_info"):
                assert trace not in content
            assert (SIGNATURE in content) or target != "macos-arm64"
            assert b"seacage_march" in content, "it is stripped of what Python calls"
        (metadata,) = (n for n in listed if n.endswith(".dist-info/WHEEL"))
        assert f"Tag: py3-none-{tag}" in file.read(metadata).decode().splitlines()
        (record_name,) = (n for n in listed if n.endswith("/RECORD"))
        rows = list(csv.reader(StringIO(file.read(record_name).decode())))
        assert {row[0] for row in rows} == set(listed)
        for name, digest, size in rows:
            if name != record_name:
                content = file.read(name)
                found = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=")
                assert (f"sha256={found.decode()}", str(len(content))) == (digest, size)


@pytest.mark.skipif(sys.platform != "linux", reason="auditwheel reads Linux's libraries")
@pytest.mark.parametrize("target", ["linux-x86_64", "linux-aarch64", "musl-x86_64"])
def test_auditwheel_agrees_with_the_tag(wheel, tools, target):
    words = tools("auditwheel", "show", wheel(target)).split()
    assert f'platform tag: "{WHEELS[target][0]}"' in " ".join(words)


def test_a_wheel_is_built_outside_the_tree(wheel):
    room = ROOT / "src/seacage/dynamics/_kernel"
    before = {path.name: path.stat().st_mtime_ns for path in room.iterdir()}
    wheel("windows-x86_64")
    after = {path.name: path.stat().st_mtime_ns for path in room.iterdir()}
    assert after == before
    assert not list(room.glob("*.dll"))


@pytest.mark.skipif(sys.platform != "linux", reason="runs Linux's libraries")
@pytest.mark.parametrize("name", X86)
def test_the_kernel_that_zig_compiled_answers_as_the_one_in_use(play, name):
    if LEVELS[name] > available()[1]:
        pytest.skip("this processor cannot run it")
    found = play("linux-x86_64", "x86_64-linux-gnu.2.17", name)
    assert all(found[key] < most for key, most in NEAR.items()), found


def test_the_kernel_for_arm_answers_the_same_in_an_emulator(play, qemu):
    found = play("linux-aarch64", "aarch64-linux-gnu.2.17", "native", *qemu)
    assert all(found[key] < most for key, most in NEAR.items()), found
