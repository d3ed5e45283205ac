"""Disks that fail: full, read-only, or taking no bytes."""

import fcntl
import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

FILLER = "filler"


@contextmanager
def small_disk(folder: Path, *, size: str = "48m") -> Iterator[Path]:
    """A file system of its own, in memory; skips where the session may not mount one."""
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder]
    try:
        subprocess.run(mount, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("needs the right to mount a file system")
    try:
        yield folder
    finally:
        subprocess.run(["umount", folder], check=True)


@contextmanager
def filled(folder: Path) -> Iterator[None]:
    """Let another file take every byte that is free."""
    with (folder / FILLER).open("ab", buffering=0) as file:
        for size in (1 << 20, 1 << 12, 1):
            with suppress(OSError):
                while file.write(bytes(size)) == size:
                    pass
    yield
    (folder / FILLER).unlink()


@contextmanager
def log_not_written(path: Path) -> Iterator[None]:
    """Have every write to a database's log fail in the kernel, and reads go on."""
    log = path.with_name(path.name + "-wal")
    descriptors = [
        int(one.name)
        for one in Path("/proc/self/fd").iterdir()
        if _leads_to(one, log) and fcntl.fcntl(int(one.name), fcntl.F_GETFL) & os.O_RDWR
    ]
    assert descriptors
    kept = [os.dup(one) for one in descriptors]
    readable = os.open(log, os.O_RDONLY)
    for one in descriptors:
        os.dup2(readable, one)
    try:
        yield
    finally:
        for one, whole in zip(descriptors, kept, strict=True):
            os.dup2(whole, one)
            os.close(whole)
        os.close(readable)


def _leads_to(descriptor: Path, path: Path) -> bool:
    try:
        return descriptor.readlink() == path
    except OSError:  # that of the listing itself
        return False
