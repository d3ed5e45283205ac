from collections.abc import Iterator
from pathlib import Path

import pytest

from running_service import Running, running


@pytest.fixture
def live(tmp_path: Path) -> Iterator[Running]:
    """A service of one's own, with a small twin and a clock that the test moves."""
    with running(tmp_path) as one:
        yield one


@pytest.fixture(scope="module")
def idle(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that the tests of a file share, for those that change nothing."""
    with running(tmp_path_factory.mktemp("idle")) as one:
        yield one
