"""The twins that cages have had: each kept whole in the data folder, and when it was in force."""

import os
import shutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from functools import lru_cache
from pathlib import Path

import numpy as np
import structlog
from pydantic import TypeAdapter, ValidationError

from seacage.conventions import InputError, ModelError
from seacage.dynamics import PHYSICS
from seacage.ocean import SeaState
from seacage.service._small_files import rewrite_small
from seacage.twin import Twin

_ID_DIGITS = 16  # of a twin's hash: enough that two never meet by chance
_log = structlog.get_logger(__name__)
_read = lru_cache(maxsize=4)(Twin.read)  # the twins in force, and one before for the past


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """A twin that somebody wants in force."""

    twin: str  # its hash
    configured: str  # hash of the twin in the folder that the settings name, at that time
    who: str
    why: str = ""
    refused: str = ""  # why the service did not take it; empty until it is known


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A twin's time in force, until the next term."""

    since: datetime | None  # by the cage's clock; None for the first, which has all before too
    twin: str  # its hash
    configured: str  # as of the request
    who: str = ""
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinLog:
    """The twins of a cage, the last one in force, and the one that is to follow it."""

    terms: tuple[Term, ...] = ()
    request: Request | None = None

    @property
    def last(self) -> Request | Term | None:
        """What to start with: what was asked for, else what was in force."""
        asked = self.request if self.request and not self.request.refused else None
        return asked or (self.terms[-1] if self.terms else None)

    def at(self, t: datetime) -> Term:
        """Return the term that a time belongs to."""
        return next(one for one in reversed(self.terms) if one.since is None or one.since <= t)


_LOG = TypeAdapter(TwinLog)


class TwinShelf:
    """The folder ``twins`` of a service's data.

    A twin lies in a folder named by its hash, and is never changed. ``CAGE.json`` is the log of a
    cage, which a command and a running service both change, one at a time: its replacement by
    another file is the one step by which a twin comes into force. So whoever is killed leaves the
    old twin or the new one in force, whole, and at most a folder that nothing names.

    ``folder``: the service's data folder. ``key``: that twins are signed with; None takes any.
    """

    def __init__(self, folder: Path, *, key: bytes | None = None) -> None:
        self._folder, self._key = folder / "twins", key
        self._seen: dict[str, tuple[tuple[int, int], TwinLog]] = {}

    def cages(self) -> list[str]:
        """Name the cages that have had a twin."""
        return sorted(path.stem for path in self._folder.glob("*.json"))

    def log(self, cage: str) -> TwinLog:
        """Read the log of a cage; a file that has not changed is not read again."""
        path = self._path(cage)
        try:
            status = path.stat()
        except FileNotFoundError:
            return TwinLog()
        place = status.st_ino, status.st_mtime_ns
        if cage not in self._seen or self._seen[cage][0] != place:
            self._seen[cage] = place, _parsed(path.read_text("utf-8"), path)
        return self._seen[cage][1]

    def read(self, twin: str) -> Twin:
        """Read a kept twin by its hash. Raises ModelError: it is gone, damaged or not signed."""
        return _read(self._folder / twin, key=self._key)

    def choose(self, name: str | None, configured: Path) -> tuple[str, Twin]:
        """Choose the twin to start with: what was asked for, else what was in force.

        A folder of the settings whose twin is another one than before comes first.

        ``name``: of the cage; None for the twin's own. ``configured``: folder of the settings.

        Raises ModelError: the folder is no twin's, or not signed by the key, and there is no key or
        no twin before.
        """
        try:
            twin = Twin.read(configured, key=self._key)
        except ModelError as error:
            name = name or next(iter(self.cages()), "")
            if self._key is None or not (last := self.log(name).last):
                raise
            _log.error("twin refused, the last one serves on", cage=name, reason=str(error))
            return name, self.read(last.twin)
        name, own = name or twin.cage.name, hash_of(twin)
        last = self.log(name).last
        if last and last.configured == own:
            try:
                return name, twin if last.twin == own else self.read(last.twin)
            except ModelError as error:
                _log.error("the twin of the settings serves", cage=name, reason=str(error))
        try:
            self._keep(configured, own)
            request = Request(twin=own, configured=own, who="settings")
            self._change(name, lambda log: replace(log, request=request))
        except OSError as error:  # a full disk does not stop a start
            _log.warning("twin not kept", cage=name, reason=str(error))
        return name, twin

    def ask(self, cage: str, source: Path | None, *, who: str, why: str) -> str:
        """Check a twin, keep it, and ask that it follow the one in force; its hash.

        ``source``: folder of the twin; None for the one that was in force before.

        Raises InputError: it does not fit the cage, or there is none before.
        Raises ModelError: the folder is no twin's, damaged or not signed.
        """
        log = self.log(cage)
        if not log.terms:
            known = ", ".join(self.cages()) or "none yet"
            raise InputError(
                f"twin: no twin of a cage {cage!r} is in force; cages with one: {known}. Start "
                "`seacage serve` with the twin."
            )
        now = log.terms[-1]
        if source is None:
            earlier = (one.twin for one in reversed(log.terms) if one.twin != now.twin)
            if (before := next(earlier, None)) is None:
                raise InputError(f"twin: {cage} has had no other twin before {now.twin}.")
            source = self._folder / before
        twin = Twin.read(source, key=self._key)
        if (asked := hash_of(twin)) == now.twin:
            raise InputError(f"twin: {source} is {asked}, which is in force already.")
        check_fit(self.read(now.twin), twin)
        self._keep(source, asked)
        request = Request(twin=asked, configured=now.configured, who=who, why=why)
        self._change(cage, lambda log: replace(log, request=request))
        return asked

    def begin(self, cage: str, twin: str, now: datetime) -> TwinLog:
        """Note that a twin is in force from now on, unless it is so already; the log after it."""

        def put(log: TwinLog) -> TwinLog:
            request = log.request
            if request is None or request.twin != twin:
                return log
            last = log.terms[-1] if log.terms else None
            if last and last.twin == twin:
                terms = *log.terms[:-1], replace(last, configured=request.configured)
            else:
                about = {key: getattr(request, key) for key in ("configured", "who", "why")}
                terms = *log.terms, Term(since=now if last else None, twin=twin, **about)
            return TwinLog(terms=terms)

        return self._change(cage, put) if self.log(cage).request else self.log(cage)

    def refuse(self, cage: str, request: Request, reason: str) -> None:
        """Note why a twin that was asked for is not put in force."""
        refused = replace(request, refused=reason)
        self._change(
            cage, lambda log: replace(log, request=refused) if log.request == request else log
        )

    def _path(self, cage: str) -> Path:
        return self._folder / f"{cage}.json"

    def _change(self, cage: str, changed: Callable[[TwinLog], TwinLog]) -> TwinLog:
        path, after = self._path(cage), TwinLog()

        def rewrite(text: str) -> str:
            nonlocal after
            after = changed(_parsed(text, path) if text else TwinLog())
            return _LOG.dump_json(after, indent=1).decode()

        rewrite_small(path, rewrite)
        return after

    def _keep(self, source: Path, twin: str) -> None:
        """Copy a twin, whole or not at all, unless it is there."""
        to, fresh = self._folder / twin, self._folder / f".{twin}.new"
        try:
            Twin.read(to, key=self._key)
            return
        except ModelError:  # not there, or what is there is damaged
            shutil.rmtree(fresh, ignore_errors=True)
        shutil.copytree(source, fresh, symlinks=True)
        for path in (*fresh.iterdir(), fresh):
            path.chmod(0o700 if path == fresh else 0o600)
            _sync(path)
        if hash_of(Twin.read(fresh, key=self._key)) != twin:
            raise InputError(f"twin: {source} changed while it was copied. Copy it again.")
        shutil.rmtree(to, ignore_errors=True)
        fresh.rename(to)
        _sync(self._folder)


def hash_of(twin: Twin) -> str:
    """Name a twin by the hash of its folder's manifest; empty for one without a folder."""
    return twin.sha256[:_ID_DIGITS]


def check_fit(old: Twin, new: Twin) -> None:
    """Check that a twin can follow another one without a restart.

    Raises InputError: it has other streams, lines or nodes, comes from another simulator, or has no
    answer.
    """
    differences = [
        f"{what} {', '.join(map(str, sorted({*before} ^ {*after})))}"
        for what, before, after in (
            ("the buoy", [old.buoy], [new.buoy]),
            ("depth sensors", *([s.name for s in one.cage.depth_sensors] for one in (old, new))),
            ("shackles", *([s.name for s in one.cage.shackles] for one in (old, new))),
            ("bridles", old.bridle_names, new.bridle_names),
            ("lines", old.models.lines.names, new.models.lines.names),
            ("numbers of nodes", [old.cage.node_count], [new.cage.node_count]),
        )
        if {*before} != {*after}
    ]
    if differences:
        raise InputError(
            f"twin: the new twin differs in {'; '.join(differences)} (in only one of the two). "
            "Train it with the cage's own file, or restart the service with it."
        )
    if new.provenance.physics not in (None, PHYSICS):
        raise InputError(
            f"twin: the new twin is of PHYSICS {new.provenance.physics}, and this seacage is of "
            f"PHYSICS {PHYSICS}. Train it anew."
        )
    speed, hs = (strength / 2.0 for strength in new.models.edge)
    answer = new.predict(SeaState(current_speed=speed, current_to=90.0, hs=hs, wave_from=270.0))
    means = (answer.bridle_tension.mean, answer.sensor.mean, answer.node_position)
    if not (answer.valid[0] and all(np.isfinite(one).all() for one in means)):
        raise InputError(
            "twin: the new twin has no finite answer in a moderate sea. Train it anew."
        )


def _parsed(text: str, path: Path) -> TwinLog:
    try:
        return _LOG.validate_json(text)
    except ValidationError as error:
        raise InputError(
            f"{path} is no log of twins ({str(error).splitlines()[0]}). Move it away, and start "
            "the service with the twin."
        ) from error


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
