"""A file of samples is written by one process."""

import fcntl
from pathlib import Path
from typing import TextIO


class FileClaim:
    """A lock that the system lets go when its process ends, however it ends.

    It lies beside the file that it is about, for SQLite has locks of its own on that.

    Parameters
    ----------
    path
        Of the lock; made where there is none, and left.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file: TextIO | None = None

    @property
    def taken(self) -> bool:
        """Whether this process has it."""
        return self._file is not None

    def take(self) -> bool:
        """Take the lock; False where another has it."""
        if self._file is None:
            file = self._path.open("a", encoding="utf-8")
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                file.close()
                return False
            self._file = file
        return True

    def release(self) -> None:
        """Let it go, if it was taken."""
        if self._file is not None:
            self._file.close()
            self._file = None
