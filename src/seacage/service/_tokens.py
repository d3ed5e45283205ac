"""Bearer tokens: random, scoped, and kept only as hashes."""

import hashlib
import hmac
import json
import os
import re
import secrets
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from seacage.conventions import InputError

_SCOPE = re.compile(r"admin|(read|ingest|ack)(:[A-Za-z0-9][A-Za-z0-9_.-]{0,63})?")


@dataclass(frozen=True, slots=True, kw_only=True)
class Grant:
    """What one token may do.

    Parameters
    ----------
    sha256
        Of the token; a token is 256 random bits, so that a plain hash cannot be guessed back.
    scopes
        ``read``, ``ingest``, ``ack``, each for all cages or as ``ingest:ace`` for one;
        ``admin`` for everything.
    """

    sha256: str
    scopes: tuple[str, ...]

    def allows(self, action: str, cage: str | None) -> bool:
        """Whether the token may do this to a cage, or to none in particular."""
        wanted = {"admin", action, f"{action}:{cage}"}
        anywhere = cage is None and any(s.startswith(f"{action}:") for s in self.scopes)
        return anywhere or not wanted.isdisjoint(self.scopes)


class Tokens:
    """The tokens of a data folder, and those that live only as long as this service.

    The file grows by one line per token, so that ``seacage token new`` needs no lock and a
    running service sees the new line.

    Parameters
    ----------
    folder
        The service's data folder.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / "tokens.jsonl"
        self._passing: list[Grant] = []
        self._kept: list[Grant] = []
        self._seen: tuple[int, int] | None = None

    def mint(self, scopes: Iterable[str], *, keep: bool) -> str:
        """Make a token and return it; nobody can read it again.

        Parameters
        ----------
        scopes
            See ``Grant``.
        keep
            Write its hash down, so that it outlives this process.

        Raises
        ------
        InputError
            A scope that does not exist.
        """
        token = secrets.token_urlsafe(32)
        grant = Grant(sha256=_sha256(token), scopes=checked_scopes(scopes))
        if keep:
            self._append(grant)
        else:
            self._passing.append(grant)
        return token

    def grant(self, token: str) -> Grant | None:
        """Find what a token may do; the time taken does not tell how near a guess came."""
        presented = _sha256(token)
        found = None
        for grant in (*self._passing, *self._current()):
            if hmac.compare_digest(grant.sha256, presented):
                found = grant
        return found

    def _current(self) -> list[Grant]:
        try:
            status = self._path.stat()
        except FileNotFoundError:
            return []
        if self._seen != (status.st_mtime_ns, status.st_size):
            lines = self._path.read_text("utf-8").splitlines()
            self._kept = [_grant(line, self._path) for line in lines if line]
            self._seen = (status.st_mtime_ns, status.st_size)
        return self._kept

    def _append(self, grant: Grant) -> None:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        line = json.dumps({"sha256": grant.sha256, "scopes": grant.scopes}) + "\n"
        file = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        try:
            os.write(file, line.encode())
            os.fsync(file)
        finally:
            os.close(file)


def checked_scopes(scopes: Iterable[str]) -> tuple[str, ...]:
    """Refuse a scope that does not exist.

    Raises
    ------
    InputError
        At the first unknown scope, or where there is none.
    """
    asked = tuple(scope.strip() for scope in scopes if scope.strip())
    unknown = [scope for scope in asked if _SCOPE.fullmatch(scope) is None]
    if unknown or not asked:
        what = f"No scope is called {unknown[0]!r}." if unknown else "A token needs a scope."
        raise InputError(
            f"{what} The scopes are read, ingest and ack, each for all cages or for one as "
            "'ingest:ace', and admin."
        )
    return asked


def _grant(line: str, path: Path) -> Grant:
    try:
        entry = json.loads(line)
        return Grant(sha256=str(entry["sha256"]), scopes=checked_scopes(entry["scopes"]))
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path} holds a line that is no token ({error}). Delete the line."
        ) from error


def _sha256(token: str) -> str:
    return hashlib.sha256(token.encode()).hexdigest()
