"""The audit log: who did what and when, one line of JSON each."""

import json
from datetime import UTC, datetime
from pathlib import Path

import structlog

from seacage.service._small_files import append_line

_LONGEST = 200  # characters of a field
_log = structlog.get_logger(__name__)


class Audit:
    """Lines are only ever added. A token is named by its id, never shown.

    ``path``: of the log; None keeps none. ``most``: of the log [bytes]; beyond, it becomes the one
    before (``audit.before.jsonl``).
    """

    def __init__(self, path: Path | None, *, most: int = 4 << 20) -> None:
        self._path, self._most = path, most

    def write(
        self,
        did: str,  # what was done, or refused
        *,
        # The name and the id of a token, and the address that asked
        who: str,
        token: str = "",
        source: str = "",
        **rest: object,  # what else there is to say
    ) -> None:
        """Write one line; a disk that does not take it is reported and stops nobody."""
        if self._path is None:
            return
        line = {"t": datetime.now(UTC).isoformat(), "who": who, "token": token}
        line |= {"source": source, "did": did, **rest}
        line = {key: one[:_LONGEST] if isinstance(one, str) else one for key, one in line.items()}
        try:
            append_line(self._path, json.dumps(line), most=self._most)
        except OSError as error:
            _log.exception("the audit log takes no line", error=str(error), **line)
