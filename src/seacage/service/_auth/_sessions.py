"""Sessions of the page: a cookie that no script can read stands for a token."""

import hmac
import json
import secrets
from collections import Counter, OrderedDict
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from threading import Lock

import structlog
from pydantic import AwareDatetime, TypeAdapter

from seacage.service._auth._token_store import Grant, Tokens, digest
from seacage.service._small_files import write_small

_MOST_SESSIONS = 1000
_KEPT = TypeAdapter(dict[str, tuple[str, AwareDatetime]])
_log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """Somebody who has signed in."""

    csrf: str  # what a write has to repeat in a header, for a cookie is sent by itself
    expires: datetime


class Sessions:
    """The sessions of a data folder: a service that is started again knows them still.

    ``tokens``: that they stand for; the sessions lie beside them.
    ``lasting_s``: how long one lasts after it was begun or renewed [s].
    ``most``: of one token; its oldest ends when another begins.
    """

    def __init__(self, tokens: Tokens, *, lasting_s: float, most: int = 50) -> None:
        self._most, self._lock = most, Lock()
        self._tokens, self._lasting = tokens, timedelta(seconds=lasting_s)
        self._path = tokens.folder / "sessions.json"
        self._open = _read(self._path)

    def begin(self, grant: Grant, now: datetime) -> tuple[str, Session]:
        """Open a session; only the hash of its cookie is kept."""
        cookie = secrets.token_urlsafe(32)
        return cookie, self._session_of(cookie, grant.sha256, now)

    def renew(self, cookie: str, now: datetime) -> Session | None:
        """Let a session last anew; None where it or its token has ended."""
        found = self.find(cookie, now)
        return None if found is None else self._session_of(cookie, found[0].sha256, now)

    def find(self, cookie: str, now: datetime) -> tuple[Grant, Session] | None:
        """Find who a cookie stands for; None where it or its token has ended."""
        token_sha256, expires = self._open.get(digest(cookie), ("", now))
        grant = self._tokens.grant_of(token_sha256) if expires > now else None
        return None if grant is None else (grant, _session(cookie, expires))

    def end(self, cookie: str) -> None:
        """Close a session, if there is one."""
        with self._lock:
            if self._open.pop(digest(cookie), None):
                self._write()

    def _session_of(self, cookie: str, token_sha256: str, now: datetime) -> Session:
        expires = now + self._lasting
        with self._lock:
            for old in [one for one, (_, end) in self._open.items() if end <= now]:
                del self._open[old]
            self._open[digest(cookie)] = token_sha256, expires
            self._open.move_to_end(digest(cookie))
            own = Counter(token for token, _ in self._open.values())
            if own[token_sha256] > self._most:
                self._end_oldest(token_sha256)
            elif len(self._open) > _MOST_SESSIONS:
                self._end_oldest(own.most_common(1)[0][0])  # who has most loses one
            self._write()
        return _session(cookie, expires)

    def _end_oldest(self, token_sha256: str) -> None:
        del self._open[next(key for key, (of, _) in self._open.items() if of == token_sha256)]

    def _write(self) -> None:
        """Replace the file at once; a disk that does not take it costs a session its next start."""
        kept = {key: [token, end.isoformat()] for key, (token, end) in self._open.items()}
        try:
            write_small(self._path, json.dumps(kept))
        except OSError as error:
            _log.warning("the sessions are not kept", file=str(self._path), error=str(error))


def _session(cookie: str, expires: datetime) -> Session:
    # Made from the cookie, so that no file holds what a write repeats.
    csrf = hmac.new(cookie.encode(), b"csrf", "sha256").hexdigest()
    return Session(csrf=csrf, expires=expires)


def _read(path: Path) -> OrderedDict[str, tuple[str, datetime]]:
    """Read the sessions; a file that was damaged costs everybody a token and nothing else."""
    try:
        return OrderedDict(_KEPT.validate_json(path.read_text("utf-8")))
    except FileNotFoundError:
        return OrderedDict()
    except (OSError, ValueError) as error:
        _log.warning("the sessions cannot be read", file=str(path), error=str(error))
        return OrderedDict()
