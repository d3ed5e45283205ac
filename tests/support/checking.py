"""How annotations are checked while the tests run.

jaxtyping's import hook decorates every function of seacage. Most are never called by the tests
that a worker runs, and most have no array in their signature; so a check is made at the first
call, and jaxtyping's own, which binds the axes and costs most, only where there are axes to bind.
"""

import dataclasses
import functools
import inspect
from collections.abc import Callable
from typing import Any, Self, get_args, get_type_hints

import jaxtyping
from beartype import BeartypeConf, FrozenDict, beartype

annotated = beartype(
    conf=BeartypeConf(
        violation_type=TypeError,  # as jaxtyping's errors are, and Python's own
        is_pep484_tower=True,  # an int may stand for a float
        hint_overrides=FrozenDict({Self: object}),  # unknown to a lone method
    )
)
"""Checks the arguments and the result of what it decorates."""

with_axes = jaxtyping.jaxtyped(typechecker=annotated)
"""The same, and that axes of one name are of one length."""


def install(package: str) -> None:
    """Check what is imported of the package from now on; before its first import."""
    jaxtyping.install_import_hook(package, "checking.annotated")
    jaxtyping.jaxtyped = lambda **_: checked  # the only name that the hook puts into a module


def checked(thing: Any) -> Any:
    """The function, or the dataclass's `__init__`, checked from its first call on."""
    if not inspect.isclass(thing):
        return at_first_call(thing)
    if dataclasses.is_dataclass(thing) and "__init__" in vars(thing):
        thing.__init__ = at_first_call(thing.__init__)
    return thing


def at_first_call(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function that makes its check when it is first called."""
    check: Callable[..., Any] | None = None

    @functools.wraps(function)
    def stub(*args: Any, **kwargs: Any) -> Any:
        nonlocal check
        if check is None:
            check = (with_axes if has_axes(function) else annotated)(function)
        return check(*args, **kwargs)

    return stub


def has_axes(function: Callable[..., Any]) -> bool:
    """Whether an array's type stands in the signature, or a name that cannot be resolved."""
    try:
        hints = list(get_type_hints(function).values())
    except (NameError, TypeError):
        return True  # jaxtyping takes such a hint for Any
    while hints:
        hint = hints.pop()
        if inspect.isclass(hint) and issubclass(hint, jaxtyping.AbstractArray):
            return True
        hints.extend(get_args(hint))
    return False
