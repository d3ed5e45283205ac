"""True means of a virtual field, as three CF-NetCDF files beside its truth."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from jaxtyping import Float, Shaped

from seacage.conventions import Origin, RecordError
from seacage.records._brief import brief
from seacage.records._netcdf_file import (
    CELL_METHODS,
    NETCDF_TROUBLE,
    Variable,
    decode_times,
    encode_times,
    open_netcdf,
    write_netcdf,
)

if TYPE_CHECKING:
    import xarray

_SCHEMA = "seacage true means 1"
_BRIDLE = ("time", "bridle")
_FILES = {
    "bridles.nc": {
        "bridle_tension_mean": Variable(_BRIDLE, "N", "mean tension of each bridle"),
        "bridle_tension_std": Variable(_BRIDLE, "N", "standard deviation of each bridle's tension"),
        "bridle_tension_max": Variable(_BRIDLE, "N", "greatest tension of each bridle"),
    },
    "shape.nc": {
        "node_position": Variable(
            ("time", "node", "axis"), "m", "mean position of each node of the drawn mesh"
        )
    },
    "water.nc": {
        "current_velocity": Variable(
            ("time", "level", "heading"), "m s-1", "mean current at the cage, to"
        ),
        "hs": Variable(("time",), "m", "significant wave height at the cage"),
        "growth": Variable(("time",), "1", "growth on the netting, 0 just cleaned, 1 grown out"),
    },
}
_STATISTICS = {"std": CELL_METHODS["std"], "max": CELL_METHODS["maximum"]}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TrueMeans:
    """Means of what was true in a virtual field, over short times one after another."""

    time: Shaped[np.ndarray, " mean"]  # when each mean begins, UTC; gaps are left out
    length: float  # of the time of each mean [s]
    bridle_names: tuple[str, ...]  # of the cage
    level_depth: Float[np.ndarray, " level"]  # of the current [m]
    # Of the readings [N]
    bridle_tension_mean: Float[np.ndarray, "mean bridle"]
    bridle_tension_std: Float[np.ndarray, "mean bridle"]
    bridle_tension_max: Float[np.ndarray, "mean bridle"]
    node_position: Float[np.ndarray, "mean node 3"]  # of the nodes of the cage as drawn [m]
    current_velocity: Float[np.ndarray, "mean level 2"]  # east and north at each level [m/s]
    hs: Float[np.ndarray, " mean"]  # significant wave height [m]
    # Of what grows on the netting, 0 just cleaned, 1 grown out [-]
    growth: Float[np.ndarray, " mean"]

    __repr__ = brief

    def write(self, folder: Path | str) -> None:
        """Write ``bridles.nc``, ``shape.nc`` and ``water.nc``, in single precision."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        for file, variables in _FILES.items():
            write_netcdf(self._dataset(variables), folder / file, packed=variables)

    @classmethod
    def read(cls, folder: Path | str) -> Self:
        """Read back what ``write`` wrote.

        Raises RecordError: a file that is missing or damaged, or of another schema.
        """
        values: dict[str, Any] = {}
        for file, names in _FILES.items():
            path = Path(folder) / file
            try:
                with open_netcdf(path, _SCHEMA) as dataset:
                    found = _values(dataset, names)
                if not np.array_equal(values.get("time", found["time"]), found["time"]):
                    raise ValueError("its times are not those of the file before")
                values |= found
            except NETCDF_TROUBLE as error:
                raise RecordError(
                    f"{path}: these are no true means of a virtual field ({error}). Give the "
                    "folder `truth` of a field that was simulated in time."
                ) from error
        return cls(**values)

    def _dataset(self, variables: Mapping[str, Variable]) -> "xarray.Dataset":
        import xarray

        depth = {"units": "m", "long_name": "depth", "positive": "down"}
        axes = {
            "bridle": np.array(self.bridle_names, dtype=object),
            "axis": np.array(["x", "y", "z"], dtype=object),
            "heading": np.array(["east", "north"], dtype=object),
            "level": ("level", self.level_depth, depth),
        }
        along = {dim for variable in variables.values() for dim in variable.dims}
        return xarray.Dataset(
            {
                name: variable._replace(
                    cell_methods=_STATISTICS.get(name.rsplit("_", 1)[-1], CELL_METHODS["mean"])
                ).holding(getattr(self, name))
                for name, variable in variables.items()
            },
            coords={
                "time": encode_times(self.time, "when the mean begins, UTC"),
                **{name: axis for name, axis in axes.items() if name in along},
            },
            attrs={
                "Conventions": "CF-1.11, ACDD-1.3",
                "title": f"The truth of a {Origin.VIRTUAL_FIELD}: means over {self.length:g} s",
                "schema": _SCHEMA,
                "origin": str(Origin.VIRTUAL_FIELD),
                "mean_length_s": self.length,
            },
        )


def _values(dataset: "xarray.Dataset", names: Iterable[str]) -> dict[str, Any]:
    values: dict[str, Any] = {name: np.asarray(dataset[name].values) for name in names}
    values["time"] = decode_times(dataset)
    values["length"] = float(dataset.attrs["mean_length_s"])
    if "bridle" in dataset.coords:
        values["bridle_names"] = tuple(str(name) for name in dataset["bridle"].values)
    if "level" in dataset.coords:
        values["level_depth"] = np.asarray(dataset["level"].values)
    return values
