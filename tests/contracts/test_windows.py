"""Without the modules that Windows lacks all imports, and only a service refuses, in one sentence.

This stands in for Windows, which no test runs on.
"""

import subprocess
import sys
import tomllib

import pytest

WITHOUT = """
import sys
for name in ("fcntl", "resource", "pwd", "grp", "termios"):
    sys.modules[name] = None
"""
EVERY_MODULE = """
import importlib, pkgutil, seacage
for one in pkgutil.walk_packages(seacage.__path__, "seacage."):
    if "_kernel._kernel_" not in one.name:  # a library for ctypes, which is no module
        importlib.import_module(one.name)
        print(one.name)
"""
COMMAND = "from seacage.service import main\nmain()\n"


def run(script, *words, folder):
    words = [sys.executable, "-c", WITHOUT + script, *map(str, words)]
    return subprocess.run(words, check=False, capture_output=True, text=True, cwd=folder)


def test_every_module_imports(tmp_path):
    ran = run(EVERY_MODULE, folder=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert "seacage.service._store._database._sqlite" in ran.stdout.split()


@pytest.mark.slow
def test_a_cage_is_written_checked_and_settled(tmp_path):
    for words in (
        ("--help",),
        ("cage", "new", "mine.toml", "--circumference", 60),
        ("cage", "check", "mine.toml"),
        ("settle", "--cage", "mine.toml", "--current-speed", 0.2, "--current-to", 90),
        ("doctor", "--data", "var"),
    ):
        ran = run(COMMAND, *words, folder=tmp_path)
        assert ran.returncode == 0, ran.stderr
    assert tomllib.loads((tmp_path / "mine.toml").read_text())


@pytest.mark.parametrize(
    "words",
    [
        ("serve", "--demo", "--data", "var", "--port", 0),
        ("token", "new", "--data", "var", "--scope", "read"),
    ],
    ids=lambda words: words[0],
)
def test_a_service_says_in_one_sentence_where_it_runs(tmp_path, words):
    ran = run(COMMAND, *words, folder=tmp_path)
    assert ran.returncode == 3, ran.stderr
    (line,) = ran.stderr.splitlines()
    assert "needs the locks of Linux or macOS" in line
    assert not (tmp_path / "var").exists(), "nothing is begun"
