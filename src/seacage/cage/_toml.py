"""Cage files: TOML with the unit in every key, written with what each key means."""

import difflib
import json
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass, replace
from numbers import Integral, Real
from pathlib import Path
from types import UnionType
from typing import Any, Self, get_args, get_origin

from seacage.cage._parts import check_bound, key_of
from seacage.conventions import InputError, NonsenseError, parse_toml, read_text

Place = tuple[str | int, ...]
"""Where a key stands: its section, in an array of tables its number from 0, and its name."""


class TomlFile:
    """A value that is kept as TOML text."""

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """Read a TOML file, refused with the key's name where a key is wrong."""
        return cls.from_toml(read_text(path), source=str(path))

    @classmethod
    def from_toml(cls, text: str, *, source: str = "") -> Self:
        """Read TOML text; ``source`` names it in errors.

        Raises InputError: text that is no TOML, and any key that is unknown, missing or of the
        wrong type; NonsenseError: values that each may be, and not together.
        """
        source = source or cls.__name__.lower()
        table = parse_toml(text, source)
        try:
            return _build(cls, table, source)
        except InputError as error:
            message = str(error)
            raise NonsenseError(message if source in message else f"{source}: {message}") from error

    def to_toml(self) -> str:
        """TOML text with the unit in every key and the meaning beside it."""
        own: Any = self  # a dataclass, whose fields are what the file holds
        entries = [(key_of(parameter), getattr(self, parameter.name)) for parameter in fields(own)]
        head = [f"{key} = {_literal(value)}" for key, value in entries if not _parts(value)]
        sections = [_section(key, value) for key, value in entries if _parts(value)]
        return "\n".join([*head, "", *sections])

    def write(self, path: str | Path) -> None:
        """Write a TOML file that ``read`` takes back."""
        Path(path).write_text(self.to_toml(), "utf-8")


def _build(kind: type, table: dict[str, Any], where: str) -> Any:
    known = _parameters(kind, table, where)
    for sentence in _missing(known, table):
        raise InputError(f"{where}: {sentence}")
    return kind(**_values(known, table, where))


def _missing(known: Mapping[str, Field[Any]], table: Mapping[str, Any]) -> Iterator[str]:
    """A sentence for each key that a table needs and has not."""
    for key, parameter in known.items():
        if key not in table and parameter.default is MISSING:
            meaning = parameter.metadata.get("meaning", "a section of its own")
            yield f"the key {key!r} is missing ({meaning}). Add it."


def alter(part: Any, changes: Mapping[str, Any], where: str) -> Any:
    """A copy of a part with some keys changed, each refused as in a file."""
    known = _parameters(type(part), changes, where)
    return replace(part, **_values(known, changes, where))


def _parameters(kind: type, keys: Iterable[str], where: str) -> dict[str, Field[Any]]:
    """All parameters by their keys; none of the given keys is another."""
    known = {key_of(parameter): parameter for parameter in fields(kind)}
    for key in keys:
        if key not in known:
            close = difflib.get_close_matches(key, known, n=1)
            hint = f"did you mean {close[0]!r}?" if close else f"known are: {', '.join(known)}."
            raise InputError(f"{where}: unknown key {key!r}; {hint}")
    return known


def _values(
    known: Mapping[str, Field[Any]], table: Mapping[str, Any], where: str
) -> dict[str, Any]:
    return {
        known[key].name: _value(known[key].type, value, f"{where}, {key}")
        for key, value in table.items()
    }


def _value(kind: Any, value: Any, where: str) -> Any:
    if isinstance(kind, UnionType):
        # What may be absent has a key only where it is there.
        kind = get_args(kind)[0]
    if get_origin(kind) is tuple:
        items = value if isinstance(value, tuple) else _check_type(list, value, where)
        return tuple(_value(get_args(kind)[0], item, where) for item in items)
    if isinstance(kind, type) and is_dataclass(kind):
        return _build(kind, _check_type(dict, value, where), where)
    return kind(_check_type(kind, value, where))


_KINDS: dict[type, tuple[type, str]] = {
    dict: (Mapping, "a table"),
    list: (list, "a list"),
    str: (str, "text"),
    int: (Integral, "a whole number"),
    float: (Real, "a number"),
}


def _check_type(kind: type, value: Any, where: str) -> Any:
    accepted, meant = _KINDS[kind]
    if not isinstance(value, accepted) or isinstance(value, bool):
        raise InputError(f"{where}: must be {meant}, not {value!r}.")
    return value


def find_errors(
    kind: type, table: Mapping[str, Any], place: Place = ()
) -> Iterator[tuple[Place, str]]:
    """Whatever is wrong with a table, each sentence with its place.

    What several keys say together is looked at where each of them by itself is right.
    """
    where = ".".join(str(one + 1) if isinstance(one, int) else one for one in place)
    known = {key_of(parameter): parameter for parameter in fields(kind)}
    wrong = [(place, f"{where}: {one}") for one in _missing(known, table)]
    for key, value in table.items():
        at = (*place, key)
        if key in known and (several := _tables(known[key].type, value)):
            for number, (part, inner) in enumerate(several):
                own = (*at, number) if isinstance(value, list) else at
                wrong += find_errors(part, inner, own)
        elif sentence := _refusal(lambda: _try_key(kind, key, value, where)):  # noqa: B023
            wrong.append((at, sentence))
    if not wrong and (sentence := _refusal(lambda: _build(kind, dict(table), where))):
        wrong.append((place, sentence))
    yield from ((at, sentence.lstrip(":, ")) for at, sentence in wrong)


def _tables(kind: Any, value: Any) -> list[tuple[Any, Any]]:
    """The tables of a section, or of an array of them, with what each is to become."""
    several = value if isinstance(value, list) else [value]
    part = get_args(kind)[0] if get_origin(kind) is tuple and isinstance(value, list) else kind
    whole = is_dataclass(part) and all(isinstance(one, Mapping) for one in several)
    return [(part, one) for one in several] if whole else []


def _try_key(kind: type, key: str, value: Any, where: str) -> None:
    """Refuse a key that is unknown, or whose value is of the wrong type or out of bounds."""
    parameter = _parameters(kind, [key], where)[key]
    check_bound(parameter, _value(parameter.type, value, f"{where}, {key}"), where)


def _refusal(attempt: Callable[[], object]) -> str:
    """The sentence by which an attempt is refused; empty where it is not."""
    try:
        attempt()
    except InputError as error:
        return str(error)
    return ""


def lines_of(text: str) -> dict[Place, int]:
    """The line of each section and key of TOML text, from 1; that of the whole is the first."""
    lines, here, seen = dict[Place, int]({(): 1}), Place(), Counter[str]()
    for number, line in enumerate(text.splitlines(), start=1):
        if section := re.match(r"\s*(\[\[?)\s*([\w-]+)\s*\]", line):
            name = section[2]
            here = (name, seen[name]) if section[1] == "[[" else (name,)
            seen[name] += 1
            lines.setdefault((name,), number)
            lines.setdefault(here, number)
        elif key := re.match(r"\s*([\w-]+)\s*=", line):
            lines.setdefault((*here, key[1]), number)
    return lines


def _parts(value: Any) -> tuple[Any, ...]:
    """The part or parts that a section holds; an empty array of them has no section."""
    several = value if isinstance(value, tuple) else (value,)
    return tuple(part for part in several if is_dataclass(part))


def _section(key: str, value: Any) -> str:
    """A table, or an array of tables with what they are before the first."""
    title = f"[[{key}]]" if isinstance(value, tuple) else f"[{key}]"
    meaning = (type(_parts(value)[0]).__doc__ or "").splitlines()[0]
    tables = ["\n".join([title, *_lines(part), ""]) for part in _parts(value)]
    return "\n".join([f"# {meaning}", *tables])


def _lines(part: Any) -> list[str]:
    return [
        f"{f'{key_of(p)} = {_literal(getattr(part, p.name))}':<44} # {p.metadata['meaning']}"
        for p in fields(part)
        if getattr(part, p.name) is not None
    ]


def _literal(value: Any) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(_literal(item) for item in value) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
