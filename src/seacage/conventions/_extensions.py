"""Extensions: what other packages add to seacage under a name, by entry points."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import entry_points
from typing import Any, Literal

from seacage.conventions._errors import InputError, SeacageError

Group = Literal["screen_laws", "surrogates", "readers"]
"""What can be added: an entry point's group, after ``seacage.``."""
EXTENSION_GROUPS: tuple[Group, ...] = ("screen_laws", "surrogates", "readers")
"""All of them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Extension:
    """An object that another package adds to seacage."""

    source: str  # the package and its version
    title: str  # for messages, with name and source
    value: Any


@cache
def extension_names(group: Group) -> tuple[str, ...]:
    """Names that installed packages add to a group; none is loaded."""
    return tuple(sorted({one.name for one in entry_points(group=f"seacage.{group}")}))


@cache
def load_extension(group: Group, name: str, kind: type, ours: tuple[str, ...] = ()) -> Extension:
    """Load what a package adds under a name; ``ours`` are other names, for the refusal.

    Raises InputError: no package adds it or several do, or there is no ``kind`` behind it.
    """
    found = [one for one in entry_points(group=f"seacage.{group}") if one.name == name]
    what = f"{group.replace('_', ' ').removesuffix('s')} {name!r}"
    if not found:
        known = ", ".join((*ours, *extension_names(group))) or "none"
        raise InputError(f"No {what}; there are: {known}. Choose one, or install its package.")
    sources = [f"{one.dist.name} {one.dist.version}" if one.dist else one.value for one in found]
    title = f"{what} of {' and '.join(sorted(sources))}"
    if len(found) > 1:
        raise InputError(f"There is a {title}. Uninstall all of these packages but one.")
    value = call_extension(title, found[0].load)
    if not isinstance(value, kind):
        raise InputError(
            f"The {title} is of type {type(value).__name__}, where a {kind.__name__} is needed. "
            "Ask its authors."
        )
    return Extension(source=sources[0], title=title, value=value)


def call_extension(title: str, function: Callable[..., Any], *given: object) -> Any:
    """Call a function of another package. Raises InputError: it fails, in any way."""
    try:
        return function(*given)
    except SeacageError:
        raise
    except Exception as error:
        raise InputError(
            f"The {title} fails ({type(error).__name__}: {error}). Ask its authors, or hold it to "
            "its suite in seacage.testing."
        ) from error
