"""Inspection of a foreign NetCDF file: its variables, and the declarations that it lacks."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from seacage.records._readers import _cf

if TYPE_CHECKING:
    import xarray


def inspect_netcdf(path: Path) -> tuple[tuple[str, ...], str]:
    """Look at a NetCDF file's variables and begin its map: findings, and the map's text.

    Raises RecordError: no NetCDF file.
    """
    with _cf.open_foreign(path) as dataset:
        return _find(path, dataset)


def _find(path: Path, dataset: "xarray.Dataset") -> tuple[tuple[str, ...], str]:
    sizes = ", ".join(f"{name} {size}" for name, size in dataset.sizes.items())
    findings = [f"{path.name} is a NetCDF file with the dimensions {sizes}."]
    lines = [
        'kind = "netcdf"',
        f"title = {json.dumps(path.stem, ensure_ascii=False)}",
        'origin = "?"  # "measured" or "computed"',
    ]
    if conflict := _cf.zone_conflict(dataset):
        findings.append(f"Suspicious: {conflict.reason}.")
        lines.append(f'time_zone = "?"  # {conflict.choices}')
    read = [name for name in map(str, dataset.data_vars) if _tells(dataset, name)]
    findings += [_sentence(dataset, name) for name in map(str, dataset.data_vars)]
    dims = {str(dim) for name in read for dim in dataset[name].dims}
    at: list[str] = []
    for dim in sorted(dims):
        size = dataset.sizes[dim]
        if size == 1 or dim == "time" or _cf.is_compass(dataset, dim):
            continue
        if kind := _cf.vertical_of(dataset, dim):
            places = np.asarray(dataset[dim].values, dtype=np.float64)
            lines.append(f'{kind}_m = "?"  # one of {", ".join(f"{p:g}" for p in places)}')
        else:
            at.append(f'{dim} = "?"  # an index, 0 to {size - 1}')
    if at:
        lines += ["", "[at]", *at]
    if not read:
        findings.append("No standard name tells what to read; declare variables in the map.")
        lines += [
            "",
            '[columns."?"]  # a variable of the file',
            'quantity = "?"  # current_east, current_north, hs, …',
            'unit = "?"',
        ]
    return tuple(findings), "\n".join(lines) + "\n"


def _tells(dataset: "xarray.Dataset", name: str) -> bool:
    array = dataset[name]
    velocity = str(array.attrs.get("units", "")).startswith(("m s", "m/s", "cm s", "cm/s"))
    split = any(_cf.is_compass(dataset, dim) for dim in array.dims)
    return array.attrs.get("standard_name") in _cf.STANDARD_NAMES or (velocity and split)


def _sentence(dataset: "xarray.Dataset", name: str) -> str:
    attributes = dataset[name].attrs
    meaning = attributes.get("standard_name") or attributes.get("long_name") or "no name"
    units = attributes.get("units", "no units")
    verdict = "is read" if _tells(dataset, name) else "is not read"
    return f"{name!r} ({meaning}, {units}) {verdict}."
