"""Every name at a room's door says what it is."""

import ast
import importlib
import inspect
from pathlib import Path

import pytest

import seacage

ROOMS = sorted(path.parent.name for path in Path(seacage.__file__).parent.glob("*/__init__.py"))


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_says_what_it_is_for(room: str) -> None:
    door = importlib.import_module(f"seacage.{room}")
    assert door.__doc__
    assert door.__doc__.strip().endswith(".")


@pytest.mark.parametrize("room", ROOMS)
def test_every_public_class_and_function_has_a_docstring(room: str) -> None:
    door = importlib.import_module(f"seacage.{room}")
    public = {name: getattr(door, name) for name in door.__all__}
    callables = {
        name: value
        for name, value in public.items()
        if inspect.isroutine(value) or inspect.isclass(value)
    }
    silent = [name for name, value in callables.items() if not inspect.getdoc(value)]
    assert silent == []


def assigns(node: ast.stmt, name: str) -> bool:
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return any(isinstance(one, ast.Name) and one.id == name for one in targets)


def docstring(module: str, name: str) -> str | None:
    """Docstring below the assignment of a constant, in the module that its imports lead to."""
    text = Path(str(importlib.import_module(module).__file__)).read_text()
    body = ast.parse(text).body
    for node, after in zip(body, [*body[1:], ast.Pass()], strict=True):
        if isinstance(node, ast.ImportFrom) and name in {one.name for one in node.names}:
            return docstring(str(node.module), name)
        if assigns(node, name) and isinstance(after, ast.Expr):
            return ast.literal_eval(after.value)
    return None


@pytest.mark.parametrize("room", ROOMS)
def test_every_public_constant_has_a_docstring(room: str) -> None:
    door = importlib.import_module(f"seacage.{room}")
    constants = {
        name
        for name in door.__all__
        if not inspect.isroutine(getattr(door, name)) and not inspect.isclass(getattr(door, name))
    }
    silent = [name for name in constants if not docstring(f"seacage.{room}", name)]
    assert silent == []
