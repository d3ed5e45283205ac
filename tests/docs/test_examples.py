"""The numbered examples run as they are printed."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("[0-9]*.py"))

QUICK = {"02_simulate_a_cage.py": ["waves.gif", "6"], "03_figure_set.py": [".", "6"]}
"""Arguments that make an example quick: seconds to simulate."""


FAST = ("01", "07")
"""The examples that take a second or two."""


@pytest.mark.parametrize(
    "example",
    [
        pytest.param(path, marks=() if path.name[:2] in FAST else pytest.mark.slow, id=path.name)
        for path in EXAMPLES
    ],
)
def test_an_example_runs(example: Path, tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, str(example), *QUICK.get(example.name, [])],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip()
