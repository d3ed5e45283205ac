"""Small files that a full disk or a lost supply leaves whole, and that their owner alone reads."""

import errno
import os
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import ModuleType

from seacage.conventions import SeacageError

_OWNERS = 0o600


def system_locks() -> ModuleType:
    """The module for locks between processes, which end with the process that has them.

    Raises SeacageError: on Windows, which lacks such locks.
    """
    try:
        import fcntl
    except ImportError as error:
        raise SeacageError(
            "This works with a service's files, which needs the locks of Linux or macOS: under "
            "Windows run it in WSL or in a container."
        ) from error
    return fcntl


def write_small(path: Path, content: str | bytes, *, mode: int = _OWNERS) -> None:
    """Replace a file by another one, whole or not at all; what was written is on the disk.

    Raises OSError: the disk does not take it; the file is as it was.
    """
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    try:
        file = os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, mode)
        with os.fdopen(file, "wb") as stream:
            stream.write(content.encode() if isinstance(content, str) else content)
            stream.flush()
            os.fsync(file)
        fresh.replace(path)
    except OSError:
        with suppress(OSError):
            fresh.unlink()
        raise
    with _folder(path.parent) as folder:
        os.fsync(folder)


def rewrite_small(path: Path, changed: Callable[[str], str]) -> None:
    """Replace a file by what becomes of its text; of several processes one does so at a time."""
    locks = system_locks()
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    with _folder(path.parent) as folder:
        locks.flock(folder, locks.LOCK_EX)
        text = path.read_bytes().decode("utf-8", "replace") if path.exists() else ""
        write_small(path, changed(text))


def append_line(path: Path, line: str, *, most: int, sync: bool = False) -> None:
    """Add a line to a log, whole or not at all; one of ``most`` bytes becomes the log before.

    A line before it that was cut off, as a lost supply leaves it, gets an end: it spoils no other.
    With ``sync`` the line is on the disk afterwards.

    Raises OSError: the disk does not take it.
    """
    locks = system_locks()
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    written = line.encode() + b"\n"
    file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, _OWNERS)
    try:
        locks.flock(file, locks.LOCK_EX)
        size = os.fstat(file).st_size
        if size and os.pread(file, 1, size - 1) != b"\n":
            written = b"\n" + written
        if size and size + len(written) > most:
            path.replace(path.with_suffix(".before" + path.suffix))
            append_line(path, line, most=most, sync=sync)
        elif os.write(file, written) < len(written):
            os.ftruncate(file, size)
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
        elif sync:
            os.fsync(file)
    finally:
        os.close(file)


def keep_private(database: Path) -> None:
    """Let the owner alone read a file of SQLite, and the log and index that SQLite puts beside it.

    Call this before it is opened: to close another descriptor of an open one would end its locks.
    """
    database.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    if not database.exists():
        os.close(os.open(database, os.O_WRONLY | os.O_CREAT, _OWNERS))
    for end in ("", "-wal", "-shm"):  # new ones take their rights from the file itself
        with suppress(OSError):  # absent, or another's, who then has to say so
            database.with_name(database.name + end).chmod(_OWNERS)


@contextmanager
def _folder(path: Path) -> Generator[int]:
    folder = os.open(path, os.O_RDONLY)
    try:
        yield folder
    finally:
        os.close(folder)
