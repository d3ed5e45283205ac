"""Packages laid where Python finds them, as pip leaves them, and a law with every number."""

from collections.abc import Mapping
from pathlib import Path

from seacage.dynamics import ScreenLaw

OWN_LAW = ScreenLaw(
    title="of no author",
    coefficients=lambda s: (1.3 * s + 6.0 * s**2, s - 0.5 * s**2),
    skin_friction=0.03,
    third=0.15,
    second=-0.3,
)

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
