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

from seacage.conventions import InputError, ModelError, read_text
from seacage.dynamics import PHYSICS
from seacage.ocean import SeaState
from seacage.service._small_files import rewrite_small
from seacage.twin import Twin

_ID_DIGITS = 16  # of a twin's hash: enough that two never meet by chance
_log = structlog.get_logger(__name__)
_read = lru_cache(maxsize=4)(Twin.read)


@dataclass(frozen=True, slots=True, kw_only=True)
class Term:
    """A twin's time in force, until the next term, or the wish for one."""

    twin: str  # its hash
    configured: str  # hash of the twin in the folder of the settings when this was asked for
    since: datetime | None = None  # by the cage's clock; None for the first: all before is its own
    who: str = ""
    why: str = ""
    refused: str = ""  # why the service does not take it


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinLog:
    """The twins of a cage, the last one in force, and the one that is asked for after it."""

    terms: tuple[Term, ...] = ()
    request: Term | None = None

    @property
    def open_request(self) -> Term | None:
        """What is asked for and not refused."""
        return self.request if self.request and not self.request.refused else None

    @property
    def last(self) -> Term | None:
        """What to start with: what is asked for, else what was in force."""
        return self.open_request or (self.terms[-1] if self.terms else None)

    def at(self, t: datetime) -> Term:
        """Return the term that a time belongs to."""
        return next(one for one in reversed(self.terms) if one.since is None or one.since <= t)


_LOG = TypeAdapter(TwinLog)


class TwinShelf:
    """The folder ``twins`` of a service's data.

    A twin lies in a folder named by its hash, and is never changed. ``CAGE.json`` is the log of a
    cage, which a command and a running service change one at a time: its replacement by another
    file is the one step by which a twin comes into force. So whoever is killed leaves the old twin
    or the new one in force, whole, and at most a folder that nothing names.

    ``data``: the service's data folder. ``key``: that twins are signed with; None takes any.
    """

    def __init__(self, data: Path, *, key: bytes | None = None) -> None:
        self.folder, self._key = data / "twins", key
        # By cage: what its file was known by, and what it held
        self._known: dict[str, tuple[tuple[int, int, int] | None, TwinLog]] = {}

    def cages(self) -> list[str]:
        """Name the cages that have had a twin."""
        return sorted(path.stem for path in self.folder.glob("*.json"))

    def log(self, cage: str) -> TwinLog:
        """Read the log of a cage; one that was spoiled since is as it was.

        Raises InputError: it is none.
        """
        path, before = self.folder / f"{cage}.json", self._known.get(cage)
        status = path.stat() if path.exists() else None
        stamp = status and (status.st_ino, status.st_mtime_ns, status.st_size)
        if before is None or before[0] != stamp:  # a running service looks at every step
            try:
                before = self._known[cage] = stamp, _log_of(read_text(path) if stamp else "", path)
            except InputError as error:
                if before is None:
                    raise
                _log.error("log of twins spoiled", cage=cage, reason=str(error))
        return before[1]

    def read(self, twin: str) -> Twin:
        """Read a kept twin by its hash. Raises ModelError: it is gone, damaged or not signed."""
        return _read(self.folder / twin, key=self._key)

    def choose(self, name: str | None, configured: Path) -> tuple[str, Twin]:
        """Choose a cage's twin at a start, and its name.

        What is asked for or was in force serves, unless the folder of the settings has another twin
        than then.

        ``name``: of the cage; None for the twin's own. ``configured``: folder of the settings.

        Raises ModelError: the folder is no twin's, or not signed by the key; with a key the twin
        before serves on, if there is one.
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
            self._request(name, configured, Term(twin=own, configured=own, who="settings"))
        except OSError as error:  # a full disk does not stop a start
            _log.warning("twin not kept", cage=name, reason=str(error))
        return name, twin

    def ask(self, cage: str, source: Path | None, *, who: str, why: str) -> None:
        """Check a twin, keep it, and ask that it follow the one in force.

        ``source``: folder of the twin; None for the one that was in force before.

        Raises InputError: it does not fit the cage, or there is none before.
        Raises ModelError: the folder is no twin's, damaged or not signed.
        """
        terms = self.log(cage).terms
        if not terms:
            known = ", ".join(self.cages()) or "none"
            raise InputError(
                f"twin: no twin of {cage or 'any cage'} has been in force in {self.folder.parent} "
                f"(of {known}, there). Give the data folder of `seacage serve`, or a cage of it."
            )
        now = terms[-1]
        if source is None:
            before = [one.twin for one in terms if one.twin != now.twin]
            if not before:
                raise InputError(f"twin: {cage} has had no other twin before {now.twin}.")
            source = self.folder / before[-1]
        twin = Twin.read(source, key=self._key)
        if hash_of(twin) == now.twin:
            raise InputError(f"twin: {source} is {now.twin}, which is in force already.")
        check_fit(self.read(now.twin), twin)
        request = Term(twin=hash_of(twin), configured=now.configured, who=who, why=why)
        self._request(cage, source, request)

    def outcome(self, cage: str) -> Term | None:
        """Return the term that was asked for; None until the service has taken it.

        Raises InputError: the service has refused it.
        """
        log = self.log(cage)
        if log.request and log.request.refused:
            raise InputError(log.request.refused)
        return None if log.request else log.terms[-1]

    def begin(self, cage: str, twin: str, now: datetime) -> datetime | None:
        """Note that a twin is in force, from now on if it was not before; since when it is."""

        def put(log: TwinLog) -> TwinLog:
            if log.request is None or log.request.twin != twin:
                return log
            since, terms = now if log.terms else None, log.terms
            if terms and terms[-1].twin == twin:
                since, terms = terms[-1].since, terms[:-1]
            return TwinLog(terms=(*terms, replace(log.request, since=since)))

        log = self._change(cage, put) if self.log(cage).request else self.log(cage)
        return log.terms[-1].since if log.terms and log.terms[-1].twin == twin else None

    def refuse(self, cage: str, reason: str) -> None:
        """Note why the twin that is asked for is not taken."""
        self._change(
            cage,
            lambda log: replace(log, request=log.request and replace(log.request, refused=reason)),
        )

    def _request(self, cage: str, source: Path, request: Term) -> None:
        """Keep a twin, whole or not at all, unless it is kept already; then ask for it."""
        to, fresh = self.folder / request.twin, self.folder / f".{request.twin}.new"
        try:
            Twin.read(to, key=self._key)
        except ModelError:  # not there, or damaged
            shutil.rmtree(fresh, ignore_errors=True)
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            shutil.copytree(source, fresh, symlinks=True)
            os.sync()
            if hash_of(Twin.read(fresh, key=self._key)) != request.twin:
                raise InputError(f"twin: {source} changed while it was copied. Again.") from None
            shutil.rmtree(to, ignore_errors=True)
            fresh.rename(to)
        self._change(cage, lambda log: replace(log, request=request))

    def _change(self, cage: str, changed: Callable[[TwinLog], TwinLog]) -> TwinLog:
        path = self.folder / f"{cage}.json"
        rewrite_small(
            path, lambda text: _LOG.dump_json(changed(_log_of(text, path)), indent=1).decode()
        )
        return self.log(cage)


def hash_of(twin: Twin) -> str:
    """Name a twin by the hash of its folder's manifest; empty for one without a folder."""
    return twin.sha256[:_ID_DIGITS]


def check_fit(old: Twin, new: Twin) -> None:
    """Check that a twin can follow another one without a restart.

    Raises InputError: it has other streams, lines or nodes, comes from another simulator, or has no
    answer.
    """
    before, after = _names(old), _names(new)
    if different := sorted(before ^ after):
        raise InputError(
            f"twin: only one of the two twins has {', '.join(different[:8])}. Train the new one "
            "with the cage's own file, or restart the service with it."
        )
    if new.provenance.physics not in (None, PHYSICS):
        raise InputError(
            f"twin: it is of PHYSICS {new.provenance.physics}, and this seacage of {PHYSICS}. "
            "Train it anew."
        )
    speed, hs = (strength / 2.0 for strength in new.models.edge)
    answer = new.predict(SeaState(current_speed=speed, current_to=90.0, hs=hs, wave_from=270.0))
    means = answer.bridle_tension.mean, answer.sensor.mean, answer.node_position
    if not (answer.valid[0] and all(np.isfinite(one).all() for one in means)):
        raise InputError("twin: it has no finite answer at half of its edge. Train it anew.")


def _names(twin: Twin) -> set[str]:
    """What alarms, pages and counters know of a twin by its name."""
    cage = twin.cage
    return {
        f"the stream {twin.buoy}",
        f"{cage.node_count} nodes",
        *(f"the depth sensor {one.name}" for one in cage.depth_sensors),
        *(f"the shackle {one.name}" for one in cage.shackles),
        *(f"the line {name}" for name in {*cage.bridle_names, *twin.models.lines.names}),
    }


def _log_of(text: str, path: Path) -> TwinLog:
    try:
        return _LOG.validate_json(text) if text else TwinLog()
    except ValidationError as error:
        raise InputError(f"{path} is no log of twins. Move it away, and start anew.") from error
