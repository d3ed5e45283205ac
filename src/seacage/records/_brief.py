"""Short text of a record: names and sizes, and none of its numbers."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, cast

_LONGEST = 60  # of what is printed of a field


def brief(self: Any) -> str:
    """Describe a record in a line or two: of its arrays the type and the shape."""
    parts = [f"{one.name}={_short(getattr(self, one.name))}" for one in fields(self)]
    return f"{type(self).__name__}({', '.join(parts)})"


def _short(value: Any) -> str:
    if hasattr(value, "dtype"):
        return f"{value.dtype}{list(value.shape)}"
    text = repr(list(cast("Mapping[str, Any]", value)) if isinstance(value, Mapping) else value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
