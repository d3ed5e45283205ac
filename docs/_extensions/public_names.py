"""What autodoc cannot see through a room's door: constants, and comments beside fields."""

import ast
import importlib
import inspect
import re
import textwrap
from collections.abc import Iterator
from dataclasses import is_dataclass
from enum import Enum
from pkgutil import iter_modules
from types import ModuleType

from sphinx.application import Sphinx
from sphinx.pycode import ModuleAnalyzer

import seacage

PARAMETER = re.compile(r"``\*{0,2}\w+``(?:(?:,| and| or) ``\w+``)*: ")


def constant_doc(module: str, name: str) -> list[str]:
    """Docstring of a constant or a type alias, from the module that assigns it."""
    analyzer = ModuleAnalyzer.for_module(module)
    docs = analyzer.find_attr_docs()
    if ("", name) in docs:
        return docs["", name]
    for node in ast.parse(analyzer.code).body:
        if isinstance(node, ast.ImportFrom) and name in {one.name for one in node.names}:
            return constant_doc(str(node.module), name)
    return []


def field_lines(kind: type) -> Iterator[str]:
    """Fields of a class as they are written, with the comments on their meaning and unit."""
    lines = textwrap.dedent(inspect.getsource(kind)).splitlines()
    (body,) = ast.parse("\n".join(lines)).body
    assert isinstance(body, ast.ClassDef)
    end = body.body[0].lineno - 1
    for node in body.body:
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        if target and not ast.unparse(target).startswith("_"):
            yield from (line[4:] for line in lines[end : node.end_lineno] if line.strip())
        end = node.end_lineno or end


def has_written_fields(what: str, it: object) -> bool:
    """Whether a class is an enumeration, or a dataclass with its parameters described beside."""
    if what != "class" or not isinstance(it, type):
        return False
    beside = is_dataclass(it) and "\nParameters\n" not in str(inspect.getdoc(it))
    return beside or issubclass(it, Enum)


def contents(door: ModuleType) -> Iterator[str]:
    """The room's names by kind, each a link, to stand before their descriptions."""
    offered = {name: getattr(door, name) for name in sorted(door.__all__, key=str.lower)}
    classes = [name for name, it in offered.items() if inspect.isclass(it)]
    functions = [name for name, it in offered.items() if inspect.isroutine(it)]
    others = [name for name in offered if name not in {*classes, *functions}]
    for kind, names in (("Classes", classes), ("Functions", functions), ("Constants", others)):
        if names:
            links = " · ".join(f":py:obj:`~{door.__name__}.{name}`" for name in names)
            yield from ("", f"**{kind}:** {links}", "")


def listed(text: list[str]) -> Iterator[str]:
    """The docstring with the lines that begin with parameters (``x``: …) as items of a list."""
    item = False
    for line in text:
        if PARAMETER.match(line):
            yield from ([] if item else [""])
            item = True
            yield f"* {line}"
        else:
            item = item and bool(line.strip())
            yield f"  {line}" if item else line


def describe(_app: Sphinx, what: str, name: str, it: object, _options: object, text: list[str]):
    """Put in what a name's docstring lacks."""
    text[:] = listed(text)
    if what == "module":
        text += contents(importlib.import_module(name))
    elif what in {"attribute", "data", "property"}:
        text.insert(0, "")  # else napoleon takes the words before a colon for a type
    elif has_written_fields(what, it) and isinstance(it, type) and (fields := [*field_lines(it)]):
        text += ["", ".. code-block:: python", "", *(f"   {line}" for line in fields), ""]


def sign(_app: Sphinx, what: str, _name: str, it: object, *_signature: object):
    """Leave out a signature that would repeat the fields."""
    return ("", None) if has_written_fields(what, it) else None


def lend_docs(room: str) -> None:
    """Let autodoc find the constants of a room as if they were assigned at its door."""
    analyzer = ModuleAnalyzer.for_module(room)
    analyzer.analyze()
    door = importlib.import_module(room)
    docs = {("", name): constant_doc(room, name) for name in door.__all__}
    analyzer.attr_docs |= {key: text for key, text in docs.items() if text}


def setup(app: Sphinx) -> dict[str, bool]:
    """Listen to autodoc."""
    for room in iter_modules(seacage.__path__, "seacage."):
        lend_docs(room.name)
    app.connect("autodoc-process-docstring", describe, priority=400)
    app.connect("autodoc-process-signature", sign)
    return {"parallel_read_safe": True}
