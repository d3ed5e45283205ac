"""What could not be read is set aside with its reason, within bounds."""

import json
import time
from datetime import datetime
from pathlib import Path

import structlog

from seacage.service._small_files import append_line

_SHOWN = 1000  # bytes of a payload that are kept
_QUIET_S = 10.0
_log = structlog.get_logger(__name__)


class Quarantine:
    """A file of what was refused, one JSON object per line, and the file before it.

    Logs say the first of a burst and how many followed, for whoever sends nonsense should not
    fill the disk with it.

    ``path``: of the file. ``most``: of the file [bytes]; beyond, it becomes the file before and a
    new one begins. ``count``: how many were set aside since the service began.
    """

    def __init__(self, path: Path, *, most: int = 4 << 20) -> None:
        self._path, self._most = path, most
        self.count = self._unsaid = 0
        self._said = float("-inf")

    def put(
        self, origin: str, payload: bytes, reason: str, *, now: datetime, sync: bool = False
    ) -> bool:
        """Set a message aside; False where the disk did not take it.

        ``origin``: the topic, or the file and line, that it came by.
        ``payload``, ``reason``, ``now``: what, why and when.
        ``sync``: wait until this and all before it are on disk.
        """
        self.count += 1
        self._say(origin, reason)
        line = {"t": now.isoformat(), "from": origin[:_SHOWN], "reason": reason[:_SHOWN]}
        line |= {"bytes": len(payload), "payload": payload[:_SHOWN].decode("utf-8", "replace")}
        try:
            append_line(self._path, json.dumps(line), most=self._most, sync=sync)
        except OSError as error:
            self._say(str(self._path), f"the file takes nothing ({error})")
            return False
        return True

    def _say(self, origin: str, reason: str) -> None:
        now = time.monotonic()
        if now - self._said < _QUIET_S:
            self._unsaid += 1
            return
        _log.warning("quarantined", origin=origin[:200], reason=reason, unsaid=self._unsaid)
        self._said, self._unsaid = now, 0
