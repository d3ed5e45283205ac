"""Packages laid where Python finds them, as pip leaves them: a module and a dist-info folder."""

from collections.abc import Mapping
from pathlib import Path

Groups = Mapping[str, Mapping[str, str]]  # by group of entry points, name and place


def install(site: Path, name: str, version: str, groups: Groups, module: str) -> None:
    """Lay a package of one module."""
    (site / f"{name}.py").write_text(module)
    about = site / f"{name}-{version}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = [
        line
        for group, points in groups.items()
        for line in (f"[{group}]", *(f"{one} = {place}" for one, place in points.items()))
    ]
    (about / "entry_points.txt").write_text("\n".join(lines) + "\n")
