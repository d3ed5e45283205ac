"""Files from outside: kind, size and depth are checked before anybody works with them."""

import json
import math
import os
import stat
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any, NoReturn, cast

from seacage.conventions._errors import InputError, NonsenseError, SeacageError

TEXT_BYTES = 1 << 20
"""Most of a file that people write: settings, a cage, a map, limits, events [bytes]."""

TABLE_BYTES = 128 << 20
"""Most of a table of readings or of cases; in memory it takes up to 20 times as much [bytes]."""

MOST_NESTED = 32  # most tables and lists inside one another; what seacage writes has fewer than ten
Refusal = type[SeacageError]


def check_file(
    path: Path | str, *, most: int, refusal: Refusal = InputError, links: bool = True
) -> os.stat_result:
    """Refuse what is no regular file, or one of more than ``most`` bytes; nothing is opened.

    A link to a file does where ``links`` do.
    """
    try:
        found = Path(path).stat(follow_symlinks=links)
    except OSError as error:
        raise refusal(f"{path}: the file cannot be read ({error.strerror}).") from error
    _check(path, found, most, refusal)
    return found


def read_bytes(
    path: Path | str, *, most: int, refusal: Refusal = InputError, links: bool = True
) -> bytes:
    """Read a file that ``check_file`` passes, no more of it than ``most`` bytes."""
    check_file(path, most=most, refusal=refusal, links=links)  # opening a device may do harm
    # Without waiting: a pipe that takes the file's place now would never answer.
    flags = os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | (0 if links else os.O_NOFOLLOW)
    try:
        with os.fdopen(os.open(path, flags), "rb") as stream:
            _check(path, os.fstat(stream.fileno()), most, refusal)
            return stream.read(most)
    except OSError as error:
        raise refusal(f"{path}: the file cannot be read ({error.strerror}).") from error


def read_text(path: Path | str, *, most: int = TEXT_BYTES, refusal: Refusal = InputError) -> str:
    """Read UTF-8 text as ``read_bytes`` reads bytes."""
    try:
        return read_bytes(path, most=most, refusal=refusal).decode()
    except UnicodeDecodeError as error:
        raise refusal(f"{path}: the file cannot be read (it is no UTF-8 text).") from error


def parse_toml(
    text: str, source: str, *, refusal: Refusal = InputError, finite: bool = False
) -> dict[str, Any]:
    """Parse TOML that is not too deep, and where asked of finite numbers; ``source`` is named."""
    try:
        table = tomllib.loads(text)  # noqa: TID251
        odd = _odd(table)
    except (ValueError, RecursionError) as error:
        raise refusal(f"{source}: this is not TOML ({_why(error)}). Mend it.") from error
    if odd and finite:
        raise NonsenseError(f"{source}: {odd} is no finite number. Give one.")
    return table


def parse_json(text: str | bytes, source: str, *, refusal: Refusal = InputError) -> Any:
    """Parse JSON that is not too deep, and has no NaN or infinity as ``json.loads`` takes them."""
    try:
        value = json.loads(text, parse_constant=_refuse)
        if odd := _odd(value):
            _refuse(odd)
    except (ValueError, RecursionError) as error:
        raise refusal(f"{source}: this is no JSON ({_why(error)}). Mend it.") from error
    return value


def read_packaged_table(package: str, name: str) -> dict[str, Any]:
    """Read a TOML or JSON file that ships with a package, such as ``"seacage.records"``."""
    text = files(package).joinpath(name).read_text("utf-8")
    return parse_json(text, name) if name.endswith(".json") else parse_toml(text, name)


def _check(path: Path | str, found: os.stat_result, most: int, refusal: Refusal) -> None:
    if not stat.S_ISREG(found.st_mode):
        raise refusal(f"{path}: the file cannot be read (it is no regular file).")
    if found.st_size > most:
        raise refusal(f"{path} has {found.st_size} bytes, and at most {most} are read.")


def _odd(value: object) -> str:
    """The first number that is not finite, with its key; refused is what lies too deep."""
    level, odd = [("", value)], ""
    for _ in range(MOST_NESTED + 1):
        inner: list[tuple[str, object]] = []
        for name, one in level:
            if isinstance(one, dict):
                parts = cast("dict[str, object]", one).items()
                inner += [(f"{name}.{key}" if name else key, part) for key, part in parts]
            elif isinstance(one, list):
                inner += [(name, part) for part in cast("list[object]", one)]
            elif isinstance(one, float) and not math.isfinite(one):
                odd = odd or f"{name} = {one}"
        if not inner:
            return odd
        level = inner
    raise RecursionError


def _why(error: Exception) -> str:
    deep = isinstance(error, RecursionError)
    return f"its parts lie more than {MOST_NESTED} deep in one another" if deep else str(error)


def _refuse(number: str) -> NoReturn:
    raise ValueError(f"{number} is no finite number")
