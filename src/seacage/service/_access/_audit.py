"""The audit log: who did what and when, one line of JSON each."""

import json
import os
from datetime import UTC, datetime
from pathlib import Path

import structlog

_log = structlog.get_logger(__name__)


class Audit:
    """Lines are only ever added. A token is named by its id, never shown.

    Parameters
    ----------
    path
        Of the log; None keeps none. It is opened for each line, so that it can be rotated.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path

    def write(
        self, did: str, *, who: str, token: str = "", source: str = "", **rest: object
    ) -> None:
        """Write one line; a disk that does not take it is reported and stops nobody.

        Parameters
        ----------
        did
            What was done, or refused.
        who, token, source
            The name and the id of a token, and the address that asked.
        rest
            What else there is to say.
        """
        if self._path is None:
            return
        line = {"t": datetime.now(UTC).isoformat(), "who": who, "token": token}
        line |= {"source": source, "did": did, **rest}
        try:
            _append(self._path, json.dumps(line) + "\n")
        except OSError as error:
            _log.exception("the audit log takes no line", error=str(error), **line)


def _append(path: Path, line: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    try:
        os.write(file, line.encode())
    finally:
        os.close(file)
