"""A table of a TOML file, whose values are each of the kind that its reader expects."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Self, cast

from seacage.conventions import RecordError, parse_toml


@dataclass(frozen=True, slots=True)
class TomlTable:
    """Values by name. Each is refused by a RecordError where it is of another kind than asked."""

    values: Mapping[str, object]
    where: str  # the file and the place in it, for messages

    @classmethod
    def parse(cls, text: str, where: str) -> Self:
        """A file's table. Raises RecordError: no TOML."""
        return cls(parse_toml(text, where, refusal=RecordError), where)

    def check_names(self, known: Iterable[str]) -> None:
        """Refuse a misspelt key, with the likely one."""
        known = tuple(known)
        for name in self.values:
            if name not in known:
                close = get_close_matches(name, known, n=1)
                hint = f"Did you mean {close[0]!r}?" if close else f"Known are {', '.join(known)}."
                raise RecordError(f"{self.where}: the key {name!r} is unknown. {hint}")

    def check_filled(self) -> None:
        """Refuse a map that still holds a question of the wizard's: a value that is "?"."""
        for name, value in self.values.items():
            if isinstance(value, dict):
                self.table(name).check_filled()
            elif value == "?":
                raise RecordError(
                    f'{self.where}: {name} is still "?". Fill in what you know of the file; it is '
                    "never guessed."
                )

    def table(
        self, name: str, *, where: str | None = None, default: Mapping[str, object] | None = None
    ) -> Self:
        """A table in this one; refused where it is missing and there is no default."""
        value = self.values.get(name, default)
        if not isinstance(value, dict):
            raise RecordError(f"{self.where}: the table [{name}] is missing.")
        inside = cast("Mapping[str, object]", value)
        return type(self)(inside, where or f"{self.where}, [{name}]")

    def tables(self, name: str, *, where: str) -> list[Self]:
        """A list of tables."""
        items = self._items(name)
        if not all(isinstance(item, dict) for item in items):
            raise RecordError(f"{where}: {name} is no list of tables. Write [[…{name}]].")
        return [type(self)(cast("Mapping[str, object]", item), where) for item in items]

    def text(self, name: str, *, default: str | None = None) -> str:
        """A text; refused where it is missing and there is no default."""
        value = self.values.get(name, default)
        if not isinstance(value, str):
            raise RecordError(f'{self.where}: {name} is missing or no text. Write {name} = "…".')
        return value

    def truth(self, name: str, *, default: bool = True) -> bool:
        """Whether something holds."""
        value = self.values.get(name, default)
        if not isinstance(value, bool):
            raise RecordError(f"{self.where}: {name} = {value!r} is neither true nor false.")
        return value

    def number(self, name: str) -> float | None:
        """A number; None where it is missing."""
        return self._number(self.values[name], name) if name in self.values else None

    def numbers(self, name: str) -> tuple[float, ...]:
        """A list of numbers; empty where it is missing."""
        return tuple(self._number(item, name) for item in self._items(name))

    def names(self, name: str, *, default: tuple[str, ...] | None = None) -> tuple[str, ...]:
        """Names or numbers of columns, in a list or one; refused where there is no default."""
        value = self.values.get(name, default)
        items = cast("list[object]", value if isinstance(value, list | tuple) else [value])
        if not all(isinstance(item, str | int) and not isinstance(item, bool) for item in items):
            raise RecordError(
                f'{self.where}: {name} is missing or names no column. Write {name} = "…", or a '
                "list of names; of numbers where header = false."
            )
        return tuple(str(item) for item in items)

    def _number(self, value: object, name: str) -> float:
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise RecordError(f"{self.where}: {name} = {value!r} is no number.")
        return float(value)

    def _items(self, name: str) -> list[object]:
        value = self.values.get(name, [])
        if not isinstance(value, list):
            raise RecordError(f"{self.where}: {name} = {value!r} is no list. Write {name} = [ … ].")
        return cast("list[object]", value)
