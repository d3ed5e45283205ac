"""Every name at a room's door says what it is."""

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
