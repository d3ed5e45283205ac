"""Every room has one door: outsiders import from it, and all that it names is there."""

import ast
import importlib
import inspect
from functools import cache
from pathlib import Path

import pytest

import seacage

PACKAGE = Path(seacage.__file__).parent
ROOMS = sorted(door.parent.name for door in PACKAGE.glob("*/__init__.py"))


@cache
def imported(source: Path) -> tuple[str, ...]:
    """The full names of the modules that a file imports from; read once for all rooms."""
    names = list[str]()
    for node in ast.walk(ast.parse(source.read_text())):
        if isinstance(node, ast.ImportFrom):
            names.append(node.module or "")
        elif isinstance(node, ast.Import):
            names += (alias.name for alias in node.names)
    return tuple(names)


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_is_entered_by_its_door(room: str) -> None:
    for source in PACKAGE.rglob("*.py"):
        if source.is_relative_to(PACKAGE / room):
            continue
        through_walls = [name for name in imported(source) if name.startswith(f"seacage.{room}.")]
        assert not through_walls, f"{source.relative_to(PACKAGE)} imports {through_walls}"


@pytest.mark.parametrize("room", ROOMS)
def test_a_door_holds_one_sentence_and_names(room: str) -> None:
    first, *rest = ast.parse((PACKAGE / room / "__init__.py").read_text()).body
    assert isinstance(first, ast.Expr), "the docstring comes first"
    assert isinstance(first.value, ast.Constant)
    assert "\n" not in first.value.value
    for statement in rest:
        assert isinstance(statement, ast.Import | ast.ImportFrom | ast.Assign | ast.AnnAssign)


@pytest.mark.parametrize("room", ROOMS)
def test_what_a_door_names_is_there_and_documented(room: str) -> None:
    door = importlib.import_module(f"seacage.{room}")
    assert len(set(door.__all__)) == len(door.__all__)
    for name in door.__all__:
        found = getattr(door, name)
        if inspect.isclass(found) or inspect.isroutine(found):
            assert found.__doc__, f"seacage.{room}.{name} has no docstring"
