"""The outside programs that some tests need, and how a test runs a server of its own."""

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

PROGRAMS = {
    "mosquitto": ("mosquitto",),
    "postgres": ("postgres",),
    "node": ("node",),
    "chromium": ("chromium", "chromium-browser", "google-chrome"),
    "qemu": ("qemu-aarch64-static",),
}
"""The outside programs by marker; a fixture of the same name hands the program out."""


def program(name: str) -> Path | None:
    """Where it is installed; Debian keeps servers off the PATH."""
    servers = ["/usr/sbin", *map(str, sorted(Path("/usr/lib/postgresql").glob("*/bin")))]
    path = os.pathsep.join([os.environ.get("PATH", ""), *servers])
    found = (shutil.which(command, path=path) for command in PROGRAMS[name])
    return next((Path(place) for place in found if place), None)


@contextmanager
def serving(command: list[str | Path], **how: str) -> Iterator[None]:
    """Run a server while its tests need it."""
    silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with subprocess.Popen(command, **silent, **how) as server:
        try:
            yield
        finally:
            server.send_signal(signal.SIGINT)


def wait_for(attempt: Callable[[], object], *, seconds: float = 20.0) -> None:
    """Try again until it works; the last failure is the one to read."""
    end = time.monotonic() + seconds
    while True:
        try:
            attempt()
        except (OSError, subprocess.CalledProcessError):
            if time.monotonic() > end:
                raise
            time.sleep(0.1)
        else:
            return
