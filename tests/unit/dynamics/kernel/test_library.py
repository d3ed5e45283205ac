"""Which of the built kernels is loaded, and how another is forced."""

import os
import subprocess
import sys

import pytest

from seacage.conventions import SeacageError
from seacage.dynamics._kernel._library import choose, kernel

ALL = ["x86-64-v4", "x86-64-v3", "x86-64-v2"]


@pytest.mark.parametrize(("able", "best"), [(4, "x86-64-v4"), (3, "x86-64-v3"), (2, "x86-64-v2")])
def test_the_best_that_the_processor_can_run_is_chosen(able: int, best: str) -> None:
    assert choose(ALL, able, "") == best


def test_the_only_kernel_of_other_machines_is_chosen() -> None:
    assert choose(["native"], 0, "") == "native"


@pytest.mark.parametrize("name", ALL)
def test_a_kernel_that_is_requested_is_chosen(name: str) -> None:
    assert choose(ALL, 4, name) == name


@pytest.mark.parametrize(
    ("built", "able", "forced", "why"),
    [
        (ALL, 4, "v3", r"'v3' is no kernel of seacage; set it to x86-64-v4 or x86-64-v3 or"),
        (ALL, 3, "x86-64-v4", r"'x86-64-v4' cannot be run by this processor; set it to x86-64-v3"),
        (ALL[1:], 4, "x86-64-v4", r"'x86-64-v4' was not built here; set it to x86-64-v3 or"),
        (["native"], 0, "x86-64-v2", r"'x86-64-v2' was not built here; set it to native, or unset"),
    ],
)
def test_an_impossible_kernel_is_refused(
    built: list[str], able: int, forced: str, why: str
) -> None:
    with pytest.raises(SeacageError, match=why):
        choose(built, able, forced)


def loaded(forced: str) -> subprocess.CompletedProcess[str]:
    script = "from seacage.dynamics._kernel._library import kernel; print(kernel().library._name)"
    environment = os.environ | {"SEACAGE_KERNEL": forced}
    command = [sys.executable, "-c", script]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def test_the_environment_forces_a_kernel() -> None:
    name = kernel().library._name
    forced = "x86-64-v2" if "x86-64" in name else "native"
    assert loaded(forced).stdout.strip().rpartition("_kernel_")[2].startswith(forced)
    refused = loaded("x86-64-v9")
    assert refused.returncode
    assert refused.stderr.splitlines()[-1].startswith(
        "seacage.conventions._errors.SeacageError: SEACAGE_KERNEL = 'x86-64-v9' is no kernel"
    )
