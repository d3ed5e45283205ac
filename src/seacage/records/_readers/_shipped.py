"""The column maps that come with the package."""

from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from seacage.records._readers._column_map import ColumnMap


@cache
def shipped_maps() -> Mapping[str, ColumnMap]:
    """By name: buoys, a shelf current profile and a wave hindcast."""
    folder = files("seacage.records") / "maps"
    return {
        file.name.removesuffix(".toml"): ColumnMap.from_toml(
            file.read_text(encoding="utf-8"), where=file.name
        )
        for file in sorted(folder.iterdir(), key=lambda file: file.name)
    }
