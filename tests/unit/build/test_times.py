"""The plugin that tells where the tests' processor time goes."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
BURNS = """
import pytest, time
def burn(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end: pass
@pytest.fixture
def warm(): burn(0.1)
def test_one(warm): burn(0.2)
def test_two(): burn(0.1)
"""


@pytest.mark.parametrize("workers", [0, 2])
def test_processor_time_is_summed_by_test_and_by_file(tmp_path: Path, workers: int) -> None:
    (tmp_path / "test_burns.py").write_text(BURNS)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    result = subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "-p",
            "tools.times",
            "-n",
            str(workers),
            f"--rootdir={tmp_path}",
            str(tmp_path),
        ],
        env={"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTEST_PLUGINS": "xdist.plugin"},
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    spent = {name: float(seconds) for seconds, name in re.findall(r"([\d.]+) s  (\S+)", result)}
    burns = next(name for name in spent if name.endswith("test_burns.py"))
    # A loop that ends by its own clock takes what it says; a loaded machine adds a little to it.
    assert 0.28 < spent[f"{burns}::test_one"] < 1.0
    assert 0.08 < spent[f"{burns}::test_two"] < 1.0
    assert spent[burns] == pytest.approx(
        spent[f"{burns}::test_one"] + spent[f"{burns}::test_two"], abs=0.02
    )
    assert len(re.findall("s to start and to collect", result)) == max(workers, 1)
