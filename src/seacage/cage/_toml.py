"""Cage files: TOML with the unit in every key, written with what each key means."""

import difflib
import tomllib
import types
from dataclasses import fields, is_dataclass
from typing import Any, get_args, get_origin

from seacage.cage._parts import key_of
from seacage.conventions import InputError


def parsed(kind: type, text: str, *, source: str) -> Any:
    """A cage (or any nest of parts) from TOML text.

    Raises
    ------
    InputError
        Text that is no TOML, and any key that is unknown, missing or of the wrong type.
    """
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{source}: this is not TOML ({error}). Mend the line it names.") from error
    return _built(kind, table, source)


def _built(kind: type, table: dict[str, Any], where: str) -> Any:
    known = {key_of(parameter): parameter for parameter in fields(kind)}
    for key in table:
        if key not in known:
            close = difflib.get_close_matches(key, known, n=1)
            hint = f"did you mean {close[0]!r}?" if close else f"known are: {', '.join(known)}."
            raise InputError(f"{where}: unknown key {key!r}; {hint}")
    missing = [key for key in known if key not in table]
    if missing:
        meaning = known[missing[0]].metadata.get("meaning", "a section of its own")
        raise InputError(f"{where}: the key {missing[0]!r} is missing ({meaning}). Add it.")
    values = {
        parameter.name: _value(parameter.type, table[key], f"{where}, {key}")
        for key, parameter in known.items()
    }
    return kind(**values)


def _value(kind: Any, value: Any, where: str) -> Any:
    if get_origin(kind) is tuple:
        return tuple(_value(get_args(kind)[0], item, where) for item in _typed(list, value, where))
    if is_dataclass(kind):
        return _built(kind, _typed(dict, value, where), where)  # type: ignore[arg-type]
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    return _typed(kind, value, where)


def _typed(kind: Any, value: Any, where: str) -> Any:
    if not isinstance(value, kind) or isinstance(value, bool):
        expected = kind.__name__ if not isinstance(kind, types.UnionType) else str(kind)
        raise InputError(f"{where}: {value!r} is a {type(value).__name__}; expected {expected}.")
    return value


def written(cage: Any) -> str:
    """TOML text of a cage; ``parsed`` gives the same cage back."""
    head = [f"{key} = {_literal(value)}" for key, value in _plain(cage)]
    sections = [
        _section(f"[[{key}]]" if isinstance(value, tuple) else f"[{key}]", part)
        for key, value in _nested(cage)
        for part in (value if isinstance(value, tuple) else (value,))
    ]
    return "\n".join([*head, "", *sections])


def _section(title: str, part: Any) -> str:
    doc = (type(part).__doc__ or "").splitlines()[0]
    lines = [
        f"{f'{key_of(p)} = {_literal(getattr(part, p.name))}':<44} # {p.metadata['meaning']}"
        for p in fields(part)
    ]
    return "\n".join([f"# {doc}", title, *lines, ""])


def _plain(cage: Any) -> list[tuple[str, Any]]:
    return [(key_of(p), getattr(cage, p.name)) for p in fields(cage) if "unit" in p.metadata]


def _nested(cage: Any) -> list[tuple[str, Any]]:
    return [(key_of(p), getattr(cage, p.name)) for p in fields(cage) if "unit" not in p.metadata]


def _literal(value: Any) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(_literal(item) for item in value) + "]"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return repr(value)
