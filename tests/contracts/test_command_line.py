"""`seacage --help` answers at once, because the command line loads nothing that computes."""

import subprocess
import sys

HEAVY = {"fastapi", "numpy", "pydantic", "rich", "scipy", "structlog", "uvicorn", "xarray"}


def test_the_command_line_loads_nothing_that_computes() -> None:
    script = "import sys, seacage.service; print(*sys.modules)"
    result = subprocess.run(
        [sys.executable, "-c", script], check=True, capture_output=True, text=True
    )
    assert not HEAVY & set(result.stdout.split())
