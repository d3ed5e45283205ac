"""The map of the code: every path is there, every folder is on it, every arrow is an import."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
SRC = ROOT / "src/seacage"
TEXT = (ROOT / "docs/architecture.md").read_text()
DRAWINGS = re.findall(r"```mermaid\n(.*?)```", TEXT, re.DOTALL)


def imported(path: Path) -> Iterator[tuple[str, str]]:
    """Module and name of each import of the package's own."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("seacage"):
            yield from ((str(node.module), one.name) for one in node.names)


def file_of(module: str) -> Path:
    """File of a module, or of a package's door."""
    path = SRC.parent.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def origin(module: str, name: str) -> Path:
    """File that a name comes from, through the doors between."""
    if (whole := file_of(f"{module}.{name}")).exists():
        return whole
    door = file_of(module)
    if door.name == "__init__.py":
        for behind, one in imported(door):
            if one == name:
                return origin(behind, one)
    return door


def test_every_arrow_is_an_import() -> None:
    assert len(DRAWINGS) == 2
    for drawing in DRAWINGS:
        files = dict(re.findall(r'(\w+)\["([^"]+)"\]', drawing))
        arrows = re.findall(r"(\w+)(?:\[[^]]*\])? --> (\w+)", drawing)
        assert len(arrows) > 10
        for one, other in arrows:
            origins = {origin(*names) for names in imported(SRC / files[one])}
            assert SRC / files[other] in origins, f"{files[one]} does not import {files[other]}"


def test_every_folder_is_listed_above_those_that_it_imports() -> None:
    listed = re.findall(r"^\| `([^`]+)/` \|", TEXT, re.MULTILINE)
    folders = {path.parent.relative_to(SRC).as_posix() for path in SRC.rglob("*/__init__.py")}
    assert set(listed) == folders - {"."}
    assert len(listed) == len(set(listed))
    place = {name: number for number, name in enumerate(listed)}
    for path in SRC.glob("*/**/*.py"):
        own = path.relative_to(SRC).parts[0]
        for module, name in imported(path):
            parts = origin(module, name).relative_to(SRC).parts
            assert len(parts) == 1 or place[own] <= place[parts[0]], f"{path} imports {module}"


def test_every_path_on_it_exists() -> None:
    paths = re.findall(r"`((?:[a-z]+/)[\w/]+\.(?:py|js|c|h|toml))`", TEXT)
    assert len(paths) > 8
    for path in paths:
        assert any((root / path).exists() for root in (SRC, ROOT)), path


def test_the_tree_of_errors_is_the_tree_of_classes() -> None:
    listed, above = dict[str, str](), list[str]()
    for indent, name in re.findall(r"^( *)- `(\w+Error)`", TEXT, re.MULTILINE):
        above = [*above[: len(indent) // 2], name]
        listed[name] = above[-2] if len(above) > 1 else "Exception"
    found = dict[str, str]()
    for path in SRC.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ClassDef) and node.bases and not node.name.startswith("_"):
                base = ast.unparse(node.bases[0])
                if base in {"Exception", *listed}:
                    found[node.name] = base
    assert listed == found
