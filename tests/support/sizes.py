"""Tests of two sizes: what every run affords, and the long form, which is run now and then."""

import os
from typing import TypeVar

Size = TypeVar("Size")


def pick_size(usual: Size, whole: Size) -> Size:
    """The whole size where SEACAGE_LONG is set, as `make test-long` sets it, else the usual."""
    return whole if os.environ.get("SEACAGE_LONG") else usual
