"""Bearer tokens as they are kept: made, found, revoked, and stored only as hashes."""

import hashlib
import hmac
import json
import logging
import re
import secrets
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from seacage.conventions import InputError
from seacage.service._small_files import rewrite_small

_SCOPE = re.compile(r"admin|(read|ingest|ack)(:[A-Za-z0-9][A-Za-z0-9_.-]{0,63})?")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._@-]{0,63}")
_ID_DIGITS = 12
_log = logging.getLogger(__name__)  # Python's own: commands keep stdout for their answer


@dataclass(frozen=True, slots=True, kw_only=True)
class Grant:
    """What one token may do."""

    # Of the token; a token is 256 random bits, so that a plain hash cannot be guessed back
    sha256: str
    # ``read``, ``ingest``, ``ack``, each for all cages or as ``ingest:ace`` for one cage, or for
    # all of the site ``ace``; ``admin`` for everything
    scopes: tuple[str, ...]
    name: str = ""  # of whoever holds it, as the alarms' journal and the audit log name them
    made: str = ""  # when; empty for a token that ends with the process

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

    The file grows by one line per token made or revoked, and a running service sees the new line.
    A line that cannot be read is reported and shuts nobody out: all others stay in force, and so
    does what the service had read of it before.

    ``folder``: the service's data folder.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._path = folder / "tokens.jsonl"
        self._passing: list[Grant] = []
        self._kept: list[Grant] = []
        self._damaged: list[str] = []
        self._seen: tuple[int, int, int] | None = None

    def mint(self, scopes: Iterable[str], *, keep: bool, name: str = "") -> str:
        """Make a token and return it; nobody can read it again.

        ``scopes``: see ``Grant``.
        ``keep``: write its hash down, so that it outlives this process.
        ``name``: of whoever will hold it.

        Raises InputError: a scope that does not exist, or a name that is too long or already
        another's.
        """
        token = secrets.token_urlsafe(32)
        grant = Grant(
            sha256=digest(token),
            scopes=check_scopes(scopes),
            name=self._check_name(name),
            made=datetime.now(UTC).isoformat(timespec="seconds") if keep else "",
        )
        if keep:
            self._append(asdict(grant))
        else:
            self._passing.append(grant)
        return token

    def grant(self, token: str) -> Grant | None:
        """Find what a token may do; the time taken does not tell how near a guess came."""
        return self.grant_of(digest(token))

    def grant_of(self, sha256: str) -> Grant | None:
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
            if self._seen != (seen := (status.st_ino, status.st_mtime_ns, status.st_size)):
                self._read()
                self._seen = seen
        except FileNotFoundError:
            self._kept, self._damaged, self._seen = [], [], None
        except OSError as error:
            _log.warning("%s cannot be read (%s); the tokens stay as they were", self._path, error)
        return self._kept

    @property
    def damage(self) -> str:
        """What could not be read of the file, and what to do; empty where all could."""
        if not self._damaged:
            return ""
        return (
            f"{self._path} holds what is no token: {'; '.join(self._damaged[:3])}. The others stay "
            "in force. Delete the line, and make its token anew."
        )

    @property
    def lacks_admin(self) -> bool:
        """Whether nobody holds everything."""
        return not any("admin" in grant.scopes for grant in self.all())

    def revoke(self, named: str) -> Grant:
        """Let a token open nothing from now on.

        ``named``: the name or the id of the token.

        Raises InputError: no token is called so, or more than one.
        """
        found = [grant for grant in self.all() if named in {grant.name, grant.id}]
        if len(found) != 1:
            there = ", ".join(grant.who for grant in self.all()) or "none"
            many = f"{len(found)} tokens are" if found else "No token is"
            raise InputError(
                f"{many} called {named!r}. There are {there}; `seacage token list` shows their ids."
            )
        self._append({"revoked": found[0].sha256})
        return found[0]

    def _check_name(self, name: str) -> str:
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
        line = json.dumps(entry) + "\n"
        # A last line without its end was cut off, and must not swallow this one.
        rewrite_small(self._path, lambda text: text.removesuffix("\n") + "\n" * bool(text) + line)

    def _read(self) -> None:
        """Read the file; of a damaged one what was known before stays, unless it is revoked."""
        grants, revoked, self._damaged = dict[str, Grant](), set[str](), []
        for number, line in enumerate(self._path.read_bytes().split(b"\n"), start=1):
            try:
                entry = json.loads(line or b"{}")
                if "revoked" in entry:
                    revoked.add(str(entry["revoked"]))
                elif line:
                    grant = _grant(entry)
                    grants[grant.sha256] = grant
            except (ValueError, KeyError, TypeError) as error:
                self._damaged.append(f"line {number} ({error!r:.80})")
        if self._damaged:
            grants = {grant.sha256: grant for grant in self._kept} | grants
            _log.error("%s", self.damage)
        self._kept = [grant for grant in grants.values() if grant.sha256 not in revoked]


def check_scopes(scopes: Iterable[str]) -> tuple[str, ...]:
    """Refuse a scope that does not exist.

    Raises InputError: at the first unknown scope, or where there is none.
    """
    chosen = tuple(scope.strip() for scope in scopes if scope.strip())
    unknown = [scope for scope in chosen if _SCOPE.fullmatch(scope) is None]
    if unknown or not chosen:
        what = f"No scope is called {unknown[0]!r}." if unknown else "A token needs a scope."
        raise InputError(
            f"{what} The scopes are read, ingest and ack, each for all cages or for one as "
            "'ingest:ace', and admin."
        )
    return chosen


def digest(token: str) -> str:
    # Half a character, as JSON can carry it, is in no token and must not be an error either.
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).hexdigest()


def _grant(entry: Mapping[str, Any]) -> Grant:
    return Grant(
        sha256=str(entry["sha256"]),
        scopes=check_scopes(entry["scopes"]),
        name=str(entry.get("name", "")),
        made=str(entry.get("made", "")),
    )
