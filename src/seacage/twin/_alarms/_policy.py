"""Limits of a cage's alarms: the defaults of ``limits.toml``, and those of the settings."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any, Self, cast

from seacage.cage import Cage, mooring_lines
from seacage.conventions import InputError, read_packaged_table
from seacage.twin._alarms._alarm import Limit
from seacage.twin._settings import StreamTimeouts

FAULT = "history"  # kind whose limit serves for faults of the service that have none of their own
_KEYS = tuple(one.name for one in fields(Limit))


@cache
def default_limits() -> Mapping[str, Limit]:
    """Of each kind of alarm."""
    tables = read_packaged_table("seacage.twin._alarms", "limits.toml")
    return {kind: Limit(**table) for kind, table in tables.items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class AlarmPolicy:
    """Limits of a cage's alarms.

    ``limits``: by kind (``load``) or by name (``load.bridle-3``), which goes first. Loads are
    shares of the bridle's capacity, volumes are losses as shares of the volume in still water,
    silences are seconds; the others are 0 or 1, or shares of a test's limit.
    ``names``: the alarms of the cage; empty where no cage was given.
    ``jump_s``: largest step of the clock between two assessments [s]; after a larger one, all
    delays start again.
    """

    limits: Mapping[str, Limit]
    names: frozenset[str] = frozenset()
    jump_s: float = 1800.0

    @classmethod
    def default(
        cls,
        cage: Cage | None = None,
        *,
        buoy: str = "buoy-1",
        timeouts: StreamTimeouts | None = None,
    ) -> Self:
        """Return the default limits.

        ``cage``: names the bridles and sensors that limits may be given for.
        ``buoy``: the stream that the inputs come from.
        ``timeouts``: timeouts of the streams; None for the defaults.
        """
        timeouts = StreamTimeouts() if timeouts is None else timeouts
        limits = dict(default_limits())
        limits["silent"] = _silence(limits["silent"], timeouts.sensor_silent_after_s)
        limits[f"silent.{buoy}"] = _silence(
            replace(limits["silent"], severity=600), timeouts.stale_after_s
        )
        return cls(limits=limits, names=alarm_names(cage, buoy) if cage else frozenset())

    @classmethod
    def from_dict(
        cls,
        table: Mapping[str, object],
        cage: Cage | None = None,
        *,
        buoy: str = "buoy-1",
        timeouts: StreamTimeouts | None = None,
    ) -> Self:
        """Return the default limits, changed by a table.

        ``{"load": {"raise_at": 0.7, "clear_at": 0.6}, "load.bridle-3": {"raise_at": 0.6}}``;
        what a table leaves out stays as it is for the kind.

        Raises InputError: a kind, a name or a key that is unknown, a value that is no number, or
        limits that ``Limit`` refuses.
        """
        policy = cls.default(cage, buoy=buoy, timeouts=timeouts)
        limits = dict(policy.limits)
        for name in sorted(table, key=lambda one: "." in one):  # a name starts from its kind
            _check_name(name, policy.names)
            limits[name] = _with_table(
                limits.get(name, limits[name.partition(".")[0]]), table[name], name
            )
        return replace(policy, limits=limits)

    def limit(self, name: str) -> Limit:
        """Return the limit of an alarm."""
        names = (name, name.partition(".")[0], FAULT)
        return next(self.limits[one] for one in names if one in self.limits)


def alarm_names(cage: Cage, buoy: str) -> frozenset[str]:
    """Return the names of all alarms of a cage."""
    lines = mooring_lines(cage, anchored=True)
    strong = zip(lines.names, lines.capacity.tolist(), strict=True)
    by_kind = {
        "load": tuple(name for name, capacity in strong if math.isfinite(capacity)),
        "bridle": cage.bridle_names,
        "volume": ("net",),
        "net": ("net",),
        "silent": (buoy, *cage.sensor_names),
        "irregular": (buoy, *cage.sensor_names),
        "input": (buoy,),
        "domain": ("input",),
        "history": ("store",),
        "clock": ("service", buoy, *cage.sensor_names),
    }
    return frozenset(f"{kind}.{source}" for kind, sources in by_kind.items() for source in sources)


def _silence(limit: Limit, after_s: float) -> Limit:
    return replace(limit, raise_at=after_s, clear_at=after_s / 1.5)


def _with_table(limit: Limit, entry: object, name: str) -> Limit:
    if not isinstance(entry, Mapping):
        raise InputError(
            f"alarms: {name} = {entry!r} is no table of limits. "
            f'Write e.g. [alarms."{name}"] and below it raise_at = {limit.raise_at:g}.'
        )
    table = cast("Mapping[str, Any]", entry)
    unknown = [key for key in table if key not in _KEYS]
    if unknown:
        raise InputError(
            f"alarms, {name}: the key {unknown[0]!r} is unknown. There are: {', '.join(_KEYS)}."
        )
    for key, value in table.items():
        kinds, whole = (int, "whole ") if key == "severity" else ((int, float), "")
        if isinstance(value, bool) or not isinstance(value, kinds) or not math.isfinite(value):
            raise InputError(
                f"alarms, {name}: {key} = {value!r} is no {whole}number or not finite."
            )
    try:
        return replace(limit, **table)
    except InputError as error:
        raise InputError(f"alarms, {name}: {error}") from error


def _check_name(name: str, names: frozenset[str]) -> None:
    kind, dot, _ = name.partition(".")
    kinds = default_limits()
    if kind not in kinds:
        raise InputError(
            f"alarms: there is no kind of alarm {kind!r}. There are: {', '.join(kinds)}."
        )
    if dot and names and name not in names:
        others = sorted(one for one in names if one.startswith(f"{kind}."))
        raise InputError(
            f"alarms: there is no alarm {name!r} here. There are: {', '.join(others)}."
        )
