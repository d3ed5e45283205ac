"""Campaigns on disk: one Zarr store of simulated cases, written block by block."""

# xarray and zarr leave parts of their signatures untyped.
# pyright: reportUnknownMemberType=false

import hashlib
import shutil
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Bool, Float, Int

from seacage.conventions import Origin, RecordError, Result
from seacage.ocean import SeaState

if TYPE_CHECKING:
    import xarray

NOT_RUN = -1
"""Stands in ``result`` for a case that has not been run yet."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Variable:
    """A variable of the store: where it varies, its CF attributes and its type."""

    dims: tuple[str, ...]
    units: str
    long_name: str
    standard_name: str = ""
    dtype: str = "float64"


_SEA = {
    "current_speed": _Variable(
        dims=("case",),
        units="m s-1",
        long_name="speed of the current",
        standard_name="sea_water_speed",
    ),
    "current_to": _Variable(
        dims=("case",),
        units="degree",
        long_name="where the current goes, clockwise from true north",
        standard_name="sea_water_velocity_to_direction",
    ),
    "hs": _Variable(
        dims=("case",),
        units="m",
        long_name="significant wave height",
        standard_name="sea_surface_wave_significant_height",
    ),
    "tp": _Variable(
        dims=("case",),
        units="s",
        long_name="peak period of the waves, 0 without waves",
        standard_name="sea_surface_wave_period_at_variance_spectral_density_maximum",
    ),
    "wave_from": _Variable(
        dims=("case",),
        units="degree",
        long_name="where the waves come from, clockwise from true north",
        standard_name="sea_surface_wave_from_direction",
    ),
}

_ANSWER = {
    "node_position": _Variable(
        dims=("case", "node", "axis"), units="m", long_name="mean position of the net's nodes"
    ),
    "bridle_tension": _Variable(
        dims=("case", "line"), units="N", long_name="mean tension of the bridles"
    ),
    "net_force": _Variable(
        dims=("case", "axis"), units="N", long_name="load of the water on the netting"
    ),
    "volume": _Variable(dims=("case",), units="m3", long_name="volume inside the net"),
    "residual": _Variable(
        dims=("case",), units="N", long_name="largest unbalanced force at a node"
    ),
    "result": _Variable(dims=("case",), units="1", long_name="how the case ended", dtype="int8"),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CampaignRecord:
    """One cage in many sea states, as a simulator answered them.

    Parameters
    ----------
    cage_toml
        The cage, as its file.
    seas
        The sea state of each case.
    node_position
        Mean positions; x east, y north, z up [m].
    bridle_tension
        Mean tensions [N].
    net_force
        Load of the water on the netting [N].
    volume
        Inside the net [m3].
    residual
        Largest unbalanced force at a node [N].
    result
        How each case ended, a ``Result``. Diverged cases hold NaN.
    law
        The load law of the netting.
    seed
        Of the plan that drew the sea states.
    version
        Of the seacage that computed the answers.
    """

    cage_toml: str
    seas: tuple[SeaState, ...]
    node_position: Float[np.ndarray, "case node 3"]
    bridle_tension: Float[np.ndarray, "case line"]
    net_force: Float[np.ndarray, "case 3"]
    volume: Float[np.ndarray, " case"]
    residual: Float[np.ndarray, " case"]
    result: Int[np.ndarray, " case"]
    law: str
    seed: int
    version: str

    def __len__(self) -> int:
        return len(self.seas)

    @property
    def origin(self) -> Origin:
        """A campaign is always computed."""
        return Origin.COMPUTED

    @property
    def converged(self) -> Bool[np.ndarray, " case"]:
        """The cases to learn from."""
        return self.result == Result.CONVERGED

    @property
    def sha256(self) -> str:
        """Hash of the cage, the sea states and the answers, for what learns from them."""
        digest = hashlib.sha256(self.cage_toml.encode())
        for part in fields(self):
            value = getattr(self, part.name)
            digest.update(
                value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode()
            )
        return digest.hexdigest()


def create_campaign(
    path: Path,
    *,
    seas: Sequence[SeaState],
    nodes: int,
    lines: int,
    block: int,
    attributes: Mapping[str, str | float],
) -> None:
    """Make the store of a campaign with its sea states and no answers yet.

    It appears at ``path`` whole or not at all.

    Parameters
    ----------
    path
        Where; nothing may be there.
    seas
        The sea state of each case.
    nodes, lines
        Sizes of the cage.
    block
        Cases written at a time: the store's chunk along ``case``.
    attributes
        Of the whole store, beside those that every campaign carries.
    """
    import zarr

    unborn = path.with_name(f".{path.name}.unborn")
    shutil.rmtree(unborn, ignore_errors=True)
    unborn.parent.mkdir(parents=True, exist_ok=True)
    group = zarr.create_group(
        unborn, zarr_format=3, attributes={"Conventions": "CF-1.11, ACDD-1.3", **attributes}
    )
    size = {"case": len(seas), "node": nodes, "axis": 3, "line": lines}
    for name, variable in {**_SEA, **_ANSWER}.items():
        shape = tuple(size[dim] for dim in variable.dims)
        group.create_array(
            name,
            shape=shape,
            chunks=(min(block, shape[0]), *shape[1:]),
            dtype=variable.dtype,
            fill_value=NOT_RUN if variable.dtype == "int8" else np.nan,
            dimension_names=variable.dims,
            attributes=_attributes(name, variable),
        )
    for name in _SEA:
        _array(unborn, name)[:] = np.array([getattr(sea, name) for sea in seas])
    with warnings.catch_warnings():  # zarr warns that other libraries may not look for this
        warnings.simplefilter("ignore")
        zarr.consolidate_metadata(unborn)
    unborn.rename(path)


def write_cases(path: Path, first: int, answers: Mapping[str, np.ndarray]) -> None:
    """Write one block of answers, from case ``first`` on.

    ``result`` goes last: a block whose results are there is there whole.
    """
    for name in _ANSWER:
        values = answers[name]
        _array(path, name)[first : first + len(values)] = values


def campaign_results(path: Path) -> tuple[dict[str, Any], Int[np.ndarray, " case"], int]:
    """Attributes, result of each case (``NOT_RUN`` where there is none) and block size.

    Raises
    ------
    RecordError
        There is no campaign at ``path``.
    """
    import zarr

    try:
        attributes = dict(zarr.open_group(path, mode="r").attrs)
        result = _array(path, "result")
    except (OSError, KeyError, ValueError) as error:
        raise _not_a_campaign(path) from error
    return attributes, np.asarray(result[:]), int(result.chunks[0])


def read_campaign(path: str | Path) -> CampaignRecord:
    """A finished campaign from its Zarr store, or from the NetCDF file exported from it.

    Raises
    ------
    RecordError
        No campaign is there, or some of its cases have not been run.
    """
    with _opened(Path(path)) as dataset:
        variables = {name: np.asarray(dataset[name].values) for name in {**_SEA, **_ANSWER}}
        attributes = dict(dataset.attrs)
    missing = int(np.sum(variables["result"] == NOT_RUN))
    if missing:
        raise RecordError(
            f"{path}: {missing} of {len(variables['result'])} cases of this campaign have not "
            "been run. Run the campaign again; it goes on where it stopped."
        )
    return CampaignRecord(
        cage_toml=attributes["cage"],
        seas=_seas(variables),
        **{name: variables[name] for name in _ANSWER},
        law=attributes["law"],
        seed=int(attributes["seed"]),
        version=attributes["product_version"],
    )


def export_campaign(store: str | Path, path: str | Path) -> None:
    """Write a campaign's Zarr store as one CF-NetCDF file."""
    path = Path(path)
    unborn = path.with_name(f".{path.name}.unborn")
    with _opened(Path(store)) as dataset:
        for variable in dataset.variables.values():
            variable.encoding = {}  # Zarr's own, which NetCDF does not know
        result = dataset["result"]
        result.attrs["flag_values"] = np.array(result.attrs["flag_values"], result.dtype)
        dataset.to_netcdf(unborn, engine="h5netcdf")
    unborn.replace(path)


def _array(path: Path, name: str) -> Any:
    import zarr

    return zarr.open_array(path / name, mode="r+")


def _opened(path: Path) -> "xarray.Dataset":
    import xarray

    try:
        if path.is_dir():
            dataset = xarray.open_dataset(path, engine="zarr", consolidated=False)
        else:
            dataset = xarray.open_dataset(path, engine="h5netcdf")
    except (OSError, KeyError, ValueError) as error:
        raise _not_a_campaign(path) from error
    if not {*_SEA, *_ANSWER} <= {str(name) for name in dataset.variables}:
        dataset.close()
        raise _not_a_campaign(path)
    return dataset


def _not_a_campaign(path: Path) -> RecordError:
    return RecordError(
        f"{path}: there is no campaign here. Give the folder that `seacage campaign run` "
        "wrote, or a NetCDF file exported from it."
    )


def _seas(variables: Mapping[str, np.ndarray]) -> tuple[SeaState, ...]:
    columns = zip(*(variables[name].tolist() for name in _SEA), strict=True)
    return tuple(SeaState(**dict(zip(_SEA, row, strict=True))) for row in columns)


def _attributes(name: str, variable: _Variable) -> dict[str, Any]:
    attributes: dict[str, Any] = {"units": variable.units, "long_name": variable.long_name}
    if variable.standard_name:
        attributes["standard_name"] = variable.standard_name
    if "axis" in variable.dims:
        attributes["comment"] = "axis: x east, y north, z up; z = 0 at still water"
    if name in _ANSWER:
        attributes["coordinates"] = " ".join(_SEA)
    if name == "result":
        attributes["flag_values"] = [NOT_RUN, *(int(code) for code in Result)]
        attributes["flag_meanings"] = " ".join(["not_run", *(code.name.lower() for code in Result)])
    return attributes
