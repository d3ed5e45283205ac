"""What was collected: the marks of all tests, and another order to run them in."""

import random

import pytest

MARKS = pytest.StashKey[dict[str, set[str]]]()
"""The marks of all tests that were collected, those that `-m` leaves out too."""


def shuffle(items: list[pytest.Item], seed: str) -> None:
    """Put the files into a random order, and the tests of each; all workers into the same."""
    order = random.Random(seed)
    files = {item.path: order.random() for item in items}
    items.sort(key=lambda item: (files[item.path], order.random()))
