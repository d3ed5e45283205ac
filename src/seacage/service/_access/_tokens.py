"""Bearer tokens: random, scoped, and kept only as hashes."""

import hashlib
import hmac
import json
import os
import re
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from seacage.conventions import InputError

_SCOPE = re.compile(r"admin|(read|ingest|ack)(:[A-Za-z0-9][A-Za-z0-9_.-]{0,63})?")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._@-]{0,63}")
_ID_DIGITS = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Grant:
    """What one token may do.

    Parameters
    ----------
    sha256
        Of the token; a token is 256 random bits, so that a plain hash cannot be guessed back.
    scopes
        ``read``, ``ingest``, ``ack``, each for all cages or as ``ingest:ace`` for one cage, or
        for all of the site ``ace``; ``admin`` for everything.
    name
        Of whoever holds it, as the alarms' journal and the audit log name them.
    made
        When; empty for a token that ends with the process.
    """

    sha256: str
    scopes: tuple[str, ...]
    name: str = ""
    made: str = ""

    @property
    def id(self) -> str:
        """Names the token without opening anything."""
        return self.sha256[:_ID_DIGITS]

    @property
    def who(self) -> str:
        """The name, or the id where there is none."""
        return self.name or f"token {self.id}"

    def allows(self, action: str, cage: str | None, *, site: str = "") -> bool:
        """Whether the token may do this to a cage of a site, or to none in particular."""
        wanted = {"admin", action, f"{action}:{cage}", f"{action}:{site}"}
        anywhere = cage is None and any(s.startswith(f"{action}:") for s in self.scopes)
        return anywhere or not wanted.isdisjoint(self.scopes)


class Tokens:
    """The tokens of a data folder, and those that live only as long as this service.

    The file grows by one line per token made or revoked, so that the commands need no lock and
    a running service sees the new line.

    Parameters
    ----------
    folder
        The service's data folder.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._path = folder / "tokens.jsonl"
        self._passing: list[Grant] = []
        self._kept: list[Grant] = []
        self._seen: tuple[int, int] | None = None

    def mint(self, scopes: Iterable[str], *, keep: bool, name: str = "") -> str:
        """Make a token and return it; nobody can read it again.

        Parameters
        ----------
        scopes
            See ``Grant``.
        keep
            Write its hash down, so that it outlives this process.
        name
            Of whoever will hold it.

        Raises
        ------
        InputError
            A scope that does not exist, or a name that is too long or already another's.
        """
        token = secrets.token_urlsafe(32)
        grant = Grant(
            sha256=digest(token),
            scopes=checked_scopes(scopes),
            name=self._checked_name(name),
            made=datetime.now(UTC).isoformat(timespec="seconds") if keep else "",
        )
        if keep:
            self._append(asdict(grant))
        else:
            self._passing.append(grant)
        return token

    def grant(self, token: str) -> Grant | None:
        """Find what a token may do; the time taken does not tell how near a guess came."""
        return self.kept(digest(token))

    def kept(self, sha256: str) -> Grant | None:
        """Find what the token of a hash may do."""
        found = None
        for grant in (*self._passing, *self.all()):
            if hmac.compare_digest(grant.sha256, sha256):
                found = grant
        return found

    def all(self) -> list[Grant]:
        """Return the tokens that were written down and not revoked."""
        try:
            status = self._path.stat()
        except FileNotFoundError:
            return []
        if self._seen != (status.st_mtime_ns, status.st_size):
            self._kept = _standing(self._path)
            self._seen = (status.st_mtime_ns, status.st_size)
        return self._kept

    @property
    def lacks_admin(self) -> bool:
        """Whether nobody holds everything."""
        return not any("admin" in grant.scopes for grant in self.all())

    def revoke(self, named: str) -> Grant:
        """Let a token open nothing from now on.

        Parameters
        ----------
        named
            The name or the id of the token.

        Raises
        ------
        InputError
            No token is called so, or more than one.
        """
        found = [grant for grant in self.all() if named in {grant.name, grant.id}]
        if len(found) != 1:
            there = ", ".join(grant.who for grant in self.all()) or "none"
            raise InputError(
                f"{len(found)} tokens are called {named!r}. There are {there}; `seacage token "
                "list` shows their ids."
            )
        self._append({"revoked": found[0].sha256})
        return found[0]

    def _checked_name(self, name: str) -> str:
        if name and _NAME.fullmatch(name) is None:
            raise InputError(
                f"{name!r} is no name for a token. Give letters, digits, blanks and . _ @ -, at "
                "most 64."
            )
        if name and any(grant.name == name for grant in self.all()):
            raise InputError(
                f"A token is called {name!r} already. Choose another name, or revoke that one."
            )
        return name

    def _append(self, entry: Mapping[str, object]) -> None:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        line = json.dumps(entry) + "\n"
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


def digest(token: str) -> str:
    """Hash a token or a cookie."""
    return hashlib.sha256(token.encode()).hexdigest()


def _standing(path: Path) -> list[Grant]:
    grants, revoked = list[Grant](), set[str]()
    for line in path.read_text("utf-8").splitlines():
        if not line:
            continue
        try:
            entry = json.loads(line)
            if "revoked" in entry:
                revoked.add(str(entry["revoked"]))
            else:
                grants.append(_grant(entry))
        except (ValueError, KeyError, TypeError) as error:
            raise InputError(
                f"{path} holds a line that is no token ({error}). Delete the line."
            ) from error
    return [grant for grant in grants if grant.sha256 not in revoked]


def _grant(entry: Mapping[str, Any]) -> Grant:
    return Grant(
        sha256=str(entry["sha256"]),
        scopes=checked_scopes(entry["scopes"]),
        name=str(entry.get("name", "")),
        made=str(entry.get("made", "")),
    )
