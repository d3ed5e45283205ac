"""Bigger published cases, which are not ours to copy, are read where the user keeps them."""

import os
from pathlib import Path

ABSENT = "Not computed: its table is read from the folder in SEACAGE_SHARED (default ../shared)."


def shared_file(name: str) -> Path | None:
    """A file in the folder of shared records; None where it is not there."""
    beside = Path(__file__).parents[2] / "shared"
    path = Path(os.environ.get("SEACAGE_SHARED", beside)) / name
    return path if path.is_file() else None
