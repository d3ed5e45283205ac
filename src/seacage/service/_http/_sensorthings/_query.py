"""What a SensorThings question asks for besides its path: ``$top``, ``$expand`` and their like."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta

from pydantic import TypeAdapter, ValidationError

from seacage.conventions import InputError
from seacage.service._schemas._base import Reach

MOST = 1000
FARTHEST = 10_000
_USUAL = "100"
_DEEPEST = 3
_OPTIONS = ("$top", "$skip", "$count", "$select", "$orderby", "$filter", "$expand")
_ITEM = re.compile(r"([A-Za-z]+)((?:/[A-Za-z]+)*)(?:\((.*)\))?")
_ORDER = re.compile(r"([A-Za-z@.]+)( asc| desc)?")
_TERM = re.compile(r"(resultTime|phenomenonTime) (eq|ge|gt|le|lt) (\S+)")
_TICK = timedelta(microseconds=1)
# First time, included, and last, left out; open where None
Span = tuple[datetime | None, datetime | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class QueryOptions:
    """The options of a question, or of one relation that it expands."""

    texts: Mapping[str, str]  # as they were written, by their names
    # How many at most, and how many of the first are left out
    top: int
    skip: int
    count: bool  # whether to say how many there are in all
    select: tuple[str, ...]  # names of the properties that are wanted; all where empty
    # What to order by, and whether the largest comes first; None as usual
    order: tuple[str, bool] | None
    within: Span | None  # ``$filter``, a span of time
    # What is asked of each relation that is to be told in full
    expand: Mapping[str, "QueryOptions"]


def read_query(texts: Mapping[str, str], *, depth: int = 0) -> QueryOptions:
    """Read options.

    Raises InputError: one is not known or not understood, or relations lead too far.
    """
    if depth > _DEEPEST:
        raise InputError(f"$expand: at most {_DEEPEST} relations lie within each other.")
    for name in texts:
        if name not in _OPTIONS:
            raise InputError(f"{name} is not offered. There are {', '.join(_OPTIONS)}.")
    return QueryOptions(
        texts=texts,
        top=_whole("$top", texts.get("$top", _USUAL), 1, MOST),
        skip=_whole("$skip", texts.get("$skip", "0"), 0, FARTHEST),
        count=_truth("$count", texts.get("$count", "false")),
        select=tuple(name.strip() for name in texts.get("$select", "").split(",") if name),
        order=_order(texts["$orderby"]) if "$orderby" in texts else None,
        within=_span(texts["$filter"]) if "$filter" in texts else None,
        expand={
            name: read_query(inner, depth=depth + 1)
            for name, inner in _read_expand(texts.get("$expand", "")).items()
        },
    )


def filter_text(span: Span) -> str:
    """Write a span of time as ``$filter`` has it."""
    ends = [
        (how, t.isoformat()) for how, t in zip(("ge", "lt"), span, strict=True) if t is not None
    ]
    return " and ".join(f"phenomenonTime {how} {t.replace('+00:00', 'Z')}" for how, t in ends)


def from_or_until(span: Span, t: datetime, *, newest: bool) -> Span:
    """Cut a span off before a time, or behind it where the newest come first; it stays."""
    return (span[0], t + _TICK) if newest else (t, span[1])


def _read_expand(text: str) -> dict[str, dict[str, str]]:
    """Read ``A/B,C($top=1;$expand=D)`` as what is asked of A and of C."""
    found: dict[str, dict[str, str]] = {}
    for item in _split(text, ","):
        match = _ITEM.fullmatch(item.strip())
        if match is None:
            raise InputError(
                f"$expand: {item.strip()!r} is not understood. Write e.g. "
                "Datastreams($expand=Observations($top=1))."
            )
        name, path, inside = match[1], match[2], match[3] or ""
        if path:  # what stands in brackets is asked of the last of the path
            options = {"$expand": path[1:] + (f"({inside})" if inside else "")}
        else:
            options = dict(_pair(part) for part in _split(inside, ";"))
        before = found.setdefault(name, {})
        both = [one["$expand"] for one in (before, options) if "$expand" in one]
        found[name] = before | options | ({"$expand": ",".join(both)} if both else {})
    return found


def _pair(text: str) -> tuple[str, str]:
    name, _, value = text.strip().partition("=")
    return name, value


def _split(text: str, mark: str) -> list[str]:
    """Split at each mark that stands in no brackets."""
    parts, depth = [""], 0
    for letter in text:
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if letter == mark and not depth:
            parts.append("")
        else:
            parts[-1] += letter
    return [part for part in parts if part.strip()]


def _whole(name: str, text: str, least: int, most: int) -> int:
    if re.fullmatch(r"[0-9]{1,6}", text) and least <= int(text) <= most:
        return int(text)
    raise InputError(f"{name}: {text!r} is no whole number of {least} to {most}.")


def _truth(name: str, text: str) -> bool:
    if text in {"true", "false"}:
        return text == "true"
    raise InputError(f"{name}: {text!r} is neither true nor false.")


def _order(text: str) -> tuple[str, bool]:
    match = _ORDER.fullmatch(text.strip())
    if match is None:
        raise InputError(f"$orderby: {text!r} is not understood. Write one property, then desc.")
    return match[1], match[2] == " desc"


def _span(text: str) -> Span:
    start, end = None, None
    for term in text.split(" and "):
        match = _TERM.fullmatch(term.strip())
        if match is None:
            raise InputError(
                f"$filter: {term.strip()!r} is not understood. Observations are filtered by time, "
                "as phenomenonTime ge 2018-01-26T00:00:00Z, terms joined by and; nothing else is."
            )
        t, how = _time(match[3]), match[2]
        if how in {"eq", "ge", "gt"}:
            low = t + _TICK if how == "gt" else t
            start = low if start is None else max(start, low)
        if how in {"eq", "le", "lt"}:
            high = t if how == "lt" else t + _TICK
            end = high if end is None else min(end, high)
    return start, end


def _time(text: str) -> datetime:
    try:
        return TypeAdapter(Reach).validate_python(text)
    except ValidationError as error:
        raise InputError(f"$filter: {text!r} is no time with its zone.") from error
