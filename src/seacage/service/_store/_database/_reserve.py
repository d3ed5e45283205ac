"""Room on the disk that is kept for alarms, and given up when there is no other."""

import errno
import os
from contextlib import suppress
from pathlib import Path

import structlog

from seacage.service._store._database._session import FullError

SIZE = 8 << 20  # twice what SQLite's log takes before it is copied into its file [bytes]
_NO_ROOM = {errno.ENOSPC, errno.EDQUOT}
_log = structlog.get_logger(__name__)


class Reserve:
    """A file that holds room on the disk and nothing else.

    ``path``: of the file; one that a killed process left is taken over. ``size``: of the room
    [bytes].
    """

    def __init__(self, path: Path, *, size: int = SIZE) -> None:
        self._path, self._size = path, size
        self._held = self._unable = False

    def hold(self) -> None:
        """Hold the room, once.

        Raises FullError: the disk has not twice as much: samples that are taken again are not to
        fill it again at once.
        """
        if self._held or self._unable:
            return
        try:
            with self._path.open("ab") as file:
                if os.fstat(file.fileno()).st_blocks * 512 < self._size:
                    _allocate(file.fileno(), 2 * self._size)
                    file.truncate(self._size)
        except OSError as error:
            self.give_up()
            if error.errno in _NO_ROOM:
                raise FullError(
                    f"{self._path.parent} has not {2 * self._size >> 20} MiB free, of which half "
                    "is kept for alarms. No samples are taken until there is room: free the disk."
                ) from error
            # A disk that is at fault in another way says so when samples are written.
            self._unable = True
            _log.warning("no room is kept for alarms", path=str(self._path), reason=str(error))
        else:
            self._held = True

    def give_up(self) -> None:
        """Leave the room to whoever writes next."""
        self._held = False
        with suppress(OSError):  # a disk that lets nothing be deleted has no room to give
            self._path.unlink(missing_ok=True)


def _allocate(descriptor: int, size: int) -> None:
    # Not by seeking to its end: the file would have holes, and hold nothing.
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(descriptor, 0, size)
    else:
        os.pwrite(descriptor, bytes(size), 0)
