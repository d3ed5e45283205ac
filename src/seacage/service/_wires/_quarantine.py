"""What could not be read is set aside with its reason, within bounds."""

import json
import time
from datetime import datetime
from pathlib import Path

import structlog

_SHOWN = 1000  # bytes of a payload that are kept
_QUIET_S = 10.0
_log = structlog.get_logger(__name__)


class Quarantine:
    """A file of what was refused, one JSON object per line, and the file before it.

    Logs say the first of a burst and how many followed, for whoever sends nonsense should not
    fill the disk with it.

    Parameters
    ----------
    path
        Of the file; None counts and logs only.
    most
        Of the file [bytes]; beyond, it becomes the file before and a new one begins.
    """

    def __init__(self, path: Path | None, *, most: int = 4 << 20) -> None:
        self._path, self._most = path, most
        self._size = path.stat().st_size if path is not None and path.exists() else 0
        self._count = self._unsaid = 0
        self._said = float("-inf")

    @property
    def count(self) -> int:
        """How many were set aside since the service began."""
        return self._count

    def put(self, origin: str, payload: bytes, reason: str, *, now: datetime) -> None:
        """Set a message aside.

        Parameters
        ----------
        origin
            The topic, or the file and line, that it came by.
        payload, reason, now
            What, why and when.
        """
        self._count += 1
        self._say(origin, reason)
        if self._path is None:
            return
        line = {"t": now.isoformat(), "from": origin[:_SHOWN], "reason": reason[:_SHOWN]}
        line |= {"bytes": len(payload), "payload": payload[:_SHOWN].decode("utf-8", "replace")}
        try:
            self._write(self._path, json.dumps(line) + "\n")
        except OSError as error:  # a full disk: what is refused here was no sample
            self._say(str(self._path), f"the file takes nothing ({error})")

    def _write(self, path: Path, line: str) -> None:
        if self._size + len(line) > self._most:
            path.replace(path.with_suffix(".before" + path.suffix))
            self._size = 0
        with path.open("a", encoding="utf-8") as file:
            file.write(line)
        self._size += len(line)

    def _say(self, origin: str, reason: str) -> None:
        now = time.monotonic()
        if now - self._said < _QUIET_S:
            self._unsaid += 1
            return
        _log.warning("quarantined", origin=origin[:200], reason=reason, unsaid=self._unsaid)
        self._said, self._unsaid = now, 0
