"""How annotations are checked while the tests run.

jaxtyping's import hook decorates every function of seacage. Most are never called by the tests
that a worker runs, and most have no array in their signature; so a check is made at the first
call, once for all functions that one piece of code defines, and jaxtyping's own, which binds the
axes and costs most, only where there are axes to bind. What it found right once is not checked
again: arguments of the same types and shapes, and with them a result of the same type and shape.
"""

import dataclasses
import functools
import inspect
import threading
from collections.abc import Callable, Collection, Iterator
from types import CodeType, FunctionType
from typing import Any, Literal, Self, get_args, get_origin, get_type_hints

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

made: dict[int, tuple[CodeType, Callable[[FunctionType], Callable[..., Any]]]] = {}
"""A code and how its functions are checked, by its id, as others may equal it. A function that
stands inside another is defined at each call of that."""


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
    if isinstance(function, FunctionType) and not function.__annotations__:
        return function
    check: Callable[..., Any] | None = None

    @functools.wraps(function)
    def stub(*args: Any, **kwargs: Any) -> Any:
        nonlocal check
        if check is None:
            check = check_of(function)
        return check(*args, **kwargs)

    return stub


def check_of(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function with its checks."""
    if not isinstance(function, FunctionType):
        return with_axes(function)
    code = function.__code__
    if id(code) not in made:
        hints = list(hints_of(function))
        if not any(map(has_axes, hints)):
            made[id(code)] = code, without_axes(function)
        elif code.co_flags & inspect.CO_GENERATOR or any(map(asks_for_values, hints)):
            made[id(code)] = code, with_axes
        else:
            made[id(code)] = code, Shapes(function).check
    _, make = made[id(code)]
    return make(function)


def hints_of(function: FunctionType) -> Iterator[Any]:
    """The hints of a signature and all within them, or an array's where one is not resolved."""
    try:
        hints = list(get_type_hints(function, include_extras=True).values())
    except (NameError, TypeError):
        hints = [jaxtyping.AbstractArray]  # jaxtyping takes such a hint for Any
    while hints:
        yield (hint := hints.pop())
        if get_origin(hint) is not Literal:
            hints.extend(get_args(hint))


def has_axes(hint: Any) -> bool:
    """Whether a hint is an array's type."""
    return inspect.isclass(hint) and issubclass(hint, jaxtyping.AbstractArray)


def asks_for_values(hint: Any) -> bool:
    """Whether a hint asks for more than a type, a shape and a word: for an axis as long, say."""
    if get_origin(hint) is Literal:
        return not all(isinstance(one, str) for one in get_args(hint))
    return hasattr(hint, "__metadata__") or (
        has_axes(hint) and "{" in getattr(hint, "dim_str", "{")
    )


def without_axes(function: FunctionType) -> Callable[[FunctionType], Callable[..., Any]]:
    """How functions of this one's code are checked, the code of the check being made once."""
    first = annotated(function)
    if first is function:
        return lambda other: other

    def again(other: FunctionType) -> Callable[..., Any]:
        check = FunctionType(first.__code__, first.__globals__, first.__name__)
        check.__kwdefaults__ = first.__kwdefaults__ | {"__beartype_func": other}
        return check

    known = "__beartype_func" in (first.__kwdefaults__ or {})  # as beartype 0.23 has it
    return again if known else annotated


class Shapes:
    """What functions of one code have been given and have returned, as it was found right."""

    def __init__(self, function: FunctionType) -> None:
        self._results: dict[Any, set[Any]] = {}
        held = self._held = threading.local()

        def found(*_: Any, **__: Any) -> Any:
            return held.result

        # Its hints are resolved where the function was defined.
        stands = FunctionType(found.__code__, function.__globals__, closure=found.__closure__)
        self._result_check = with_axes(functools.update_wrapper(stands, function))

    def check(self, function: FunctionType) -> Callable[..., Any]:
        """The function with its checks, which are made where types or shapes are new."""
        whole: Callable[..., Any] | None = None

        def check(*args: Any, **kwargs: Any) -> Any:
            nonlocal whole
            given = described(args), tuple(kwargs), described(tuple(kwargs.values()))
            results = self._results.get(given)
            if results is None or None in given:
                whole = whole or with_axes(function)
                result = whole(*args, **kwargs)
                self._results.setdefault(given, set()).add(described(result))
                return result
            result = function(*args, **kwargs)
            returned = described(result)
            if returned is None or returned not in results:
                self._held.result = result
                try:
                    self._result_check(*args, **kwargs)
                finally:
                    del self._held.result
                results.add(returned)
            return result

        return check


def described(value: Any) -> Any:
    """Types, shapes, words and classes, all that a check asks for; None of a long collection."""
    kind = type(value)
    how = hows.get(kind)
    if how is None:
        how = hows[kind] = how_of(kind)
    return how(value)


hows: dict[type, Callable[[Any], Any]] = {}


def how_of(kind: type) -> Callable[[Any], Any]:
    """How values of a type are described."""
    if hasattr(kind, "shape") and hasattr(kind, "dtype"):
        return lambda value: (kind, value.dtype, value.shape)
    if issubclass(kind, tuple | list):
        return lambda value: describe_items(kind, value)
    if kind is dict:
        return lambda value: describe_items(kind, [*value, *value.values()])
    if issubclass(kind, type | str):
        return lambda value: (kind, value)
    if issubclass(kind, bytes) or not issubclass(kind, Collection):
        return lambda _: kind
    return lambda _: None


def describe_items(kind: type, value: Any) -> Any:
    """The descriptions of a few items in order."""
    if len(value) > 20:
        return None
    items = tuple(map(described, value))
    return None if None in items else (kind, items)
