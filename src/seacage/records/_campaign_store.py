"""The Zarr store of a campaign: made once, written block by block, finished once."""

# zarr leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import shutil
import uuid
import warnings
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from glob import escape
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from seacage.cage import MooringLines
from seacage.conventions import RecordError, Result, has_answer
from seacage.ocean import SeaState
from seacage.records._keys import KEYS
from seacage.records._lines import CONSTANT, LINES, line_variable
from seacage.records._netcdf_file import CELL_METHODS, Variable

NOT_RUN = -1
"""Stands in ``result`` for a case that has not been run yet."""

# Group of the second moments of single blocks, there until the campaign is finished
_BLOCKS = "blocks"

_CASE = ("case",)

# The sea state of each case, with the names of ``SeaState``
SEA = {
    name: Variable(_CASE, KEYS[key].cf_unit, meaning, KEYS[key].standard_name or "")
    for name, key, meaning in (
        ("current_speed", "current_speed_m_s", "speed of the current"),
        ("current_to", "current_to_deg", "where the current goes, clockwise from true north"),
        ("hs", "hs_m", "significant wave height"),
        ("tp", "tp_s", "peak period of the waves, 0 without waves"),
        ("wave_from", "wave_from_deg", "where the waves come from, clockwise from true north"),
    )
}

# And in a store of seas that have one
SHEAR = {
    "current_shear": Variable(_CASE, "m s-1", "current 30 m deep less that at the surface"),
    "shear_to": Variable(_CASE, "degree", "where that points, clockwise from true north"),
}


def sea_names(seas: Iterable[SeaState]) -> tuple[str, ...]:
    """Names of ``SeaState`` that a store of some seas holds."""
    return (*SEA, *SHEAR) if any(sea.current_shear for sea in seas) else tuple(SEA)


# What every campaign answers
MEAN = {
    "node_position": Variable(("case", "node", "axis"), "m", "mean position of the net's nodes"),
    "bridle_tension": Variable(("case", "line"), "N", "mean tension of the bridles"),
    "net_force": Variable(("case", "axis"), "N", "load of the water on the netting"),
    "volume": Variable(_CASE, "m3", "volume inside the net"),
}

_RESULT = Variable(_CASE, "1", "how the case ended", dtype="int8")
_RESIDUAL = Variable(_CASE, "N", "largest unbalanced force at a node")
_WAVE_SEED = Variable(
    _CASE, "1", "seed of the waves: a simulation with it repeats the case", dtype="int64"
)
_MOORING_SEED = Variable(
    _CASE, "1", "seed of the drawn mooring: the cage drawn with it is the case's", dtype="int64"
)
_QUANTILE = Variable(("quantile",), "1", "probability of not exceeding")
_SECOND_MOMENT = Variable(
    ("coordinate", "other_coordinate"),
    "m2",
    "mean product of two coordinates' displacements from the design shape",
    comment="coordinate 3 n + a is axis a of node n; over time and all converged cases",
)
_CORE_SECONDS = Variable(("block",), "s", "processor time that a block of cases took")


def _spread(name: str, statistic: str) -> Variable:
    """A statistic over time beside a mean; four bytes are finer than any sensor."""
    whole = MEAN[name]
    along = ("case", "quantile") if statistic == "quantile" else _CASE
    return whole._replace(
        dims=(*along, *whole.dims[1:]),
        long_name=f"{statistic} of {name.replace('_', ' ')} over time",
        cell_methods=CELL_METHODS.get(statistic, ""),
        dtype="float32",
    )


# What a campaign in time answers beside the means
SPREAD = {
    **{
        f"{name}_{statistic}": _spread(name, statistic)
        for name in ("node_position", "bridle_tension")
        for statistic in ("std", "minimum", "maximum", "quantile")
    },
    **{f"{name}_std": _spread(name, "std") for name in ("net_force", "volume")},
    "diverged_at": Variable(
        _CASE, "s", "simulated time at which the case was given up, spin-up included"
    ),
}

_LOADS = {
    f"line_{name}": line_variable(name, *_CASE, dtype="float32")
    for name in LINES
    if name not in CONSTANT
}


def create_campaign(
    path: Path,
    *,
    seas: Sequence[SeaState],  # the sea state of each case
    # Sizes of the cage: nodes of the net, and bridles
    nodes: int,
    lines: int,
    mooring: MooringLines | None = None,  # all its lines, whose loads a campaign in time keeps
    block: int,  # cases written at a time: the store's chunk along ``case``
    attributes: Mapping[str, Any],  # of the whole store, beside those that every campaign carries
    wave_seeds: Sequence[int] | None = None,  # of each case's waves; None for equilibria
    mooring_seeds: Sequence[int] | None = None,  # of each case's drawn mooring, if they are drawn
    # What a campaign in time keeps of its statistics
    quantile_levels: Sequence[float] = (),
    second_moment: bool = False,
) -> None:
    """Make the store of a campaign with its sea states and no answers yet.

    It appears at ``path`` whole or not at all. If another process made it meanwhile, that one
    stays.
    """
    variables = _variables(
        in_time=wave_seeds is not None,
        quantiles=bool(quantile_levels),
        moment=second_moment,
        lines=mooring is not None,
    )
    variables |= {} if mooring_seeds is None else {"mooring_seed": _MOORING_SEED}
    size = {"case": len(seas), "block": -(-len(seas) // block)}
    size |= {"node": nodes, "axis": 3, "line": lines, "quantile": len(quantile_levels)}
    size |= {"coordinate": 3 * nodes, "other_coordinate": 3 * nodes}
    size |= {"mooring_line": 0 if mooring is None else len(mooring.names)}
    chunk = {**size, "case": min(block, len(seas)), "block": 1}
    names = sea_names(seas)
    variables |= {name: SHEAR[name] for name in names if name in SHEAR}
    given: dict[str, Any] = {name: [getattr(sea, name) for sea in seas] for name in names}
    given |= {"wave_seed": wave_seeds, "mooring_seed": mooring_seeds, "quantile": quantile_levels}
    if mooring is not None:
        given |= {f"line_{name}": getattr(mooring, name) for name in CONSTANT}
        words = {"line_names": mooring.names, "line_kinds": mooring.kinds}
        attributes = {**attributes, **{name: ", ".join(each) for name, each in words.items()}}
    _make(path, variables, size, chunk=chunk, values=given, attributes=attributes)


def fill_campaign(
    path: Path,
    values: Mapping[str, np.ndarray],  # by the names of the store's variables
    attributes: Mapping[str, Any],
) -> None:
    """Make the store of a campaign whose answers are all known.

    Raises RecordError: there is something at ``path``.
    """
    if path.exists():
        raise RecordError(f"{path}: there is something already. Give another name, or delete it.")
    known = SHEAR | _variables(in_time=True, quantiles=True, moment=False, lines=True)
    variables = {name: known[name] for name in values}
    size = dict[str, int]()
    for name, variable in variables.items():
        size |= zip(variable.dims, values[name].shape, strict=True)
    _make(path, variables, size, chunk=size, values=values, attributes=attributes)


def _make(
    path: Path,
    variables: Mapping[str, Variable],
    size: Mapping[str, int],
    *,
    chunk: Mapping[str, int],
    values: Mapping[str, Any],  # of some of the variables
    attributes: Mapping[str, Any],
) -> None:
    """Make a store with some of its values, beside its place, and give it its name."""
    import zarr

    unborn = _beside(path, "unborn")
    try:
        unborn.mkdir(parents=True)
        group = zarr.create_group(
            unborn, zarr_format=3, attributes={"Conventions": "CF-1.11, ACDD-1.3", **attributes}
        )
        for name, variable in variables.items():
            _create_array(group, name, variable, size, chunk)
            if name in values:
                _array(unborn, name)[:] = np.array(values[name])
        with warnings.catch_warnings():  # zarr warns that other libraries may not look for this
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(unborn)
        # After the metadata was gathered, for they will go again
        if "second_moment" in variables:
            _create_block_moments(group, size["block"], size["coordinate"])
        try:
            unborn.rename(path)
        except OSError:
            if not path.is_dir():  # else another process made it meanwhile
                raise
    finally:
        shutil.rmtree(unborn, ignore_errors=True)


def write_cases(
    path: Path,
    first: int,
    answers: Mapping[str, np.ndarray],  # by the names of the store's variables
    *,
    # Sum of the second moments of the block's cases to learn from [m2]
    moment: Float[np.ndarray, "coordinate coordinate"] | None = None,
    core_seconds: float = np.nan,  # what the block took
) -> None:
    """Write one block of answers, from case ``first`` on.

    ``result`` goes last: a block whose results are there is there whole.
    """
    number = first // int(_array(path, "result").chunks[0])
    if moment is not None:
        _array(path, f"{_BLOCKS}/moment")[number] = moment
    if (path / "core_seconds").is_dir():  # the first campaigns had none
        _array(path, "core_seconds")[number] = core_seconds
    for name in (*MEAN, "residual", *SPREAD, *_LOADS, "result"):
        if (path / name).is_dir():
            values = answers[name]
            _array(path, name)[first : first + len(values)] = values


def campaign_results(path: Path) -> tuple[dict[str, Any], Int[np.ndarray, " case"], int]:
    """Attributes, result of each case (``NOT_RUN`` where there is none) and block size.

    Raises RecordError: there is no campaign at ``path``.
    """
    import zarr

    try:
        attributes = dict(zarr.open_group(path, mode="r").attrs)
        result = _array(path, "result")
    except (OSError, KeyError, ValueError) as error:
        raise not_a_campaign(path) from error
    return attributes, np.asarray(result[:]), int(result.chunks[0])


def campaign_variable(path: Path, name: str) -> np.ndarray | None:
    """One variable of a store, as far as it is written; None if this campaign has none."""
    return np.asarray(_array(path, name)[:]) if (path / name).is_dir() else None


def campaign_unsummed(path: Path) -> bool:
    """Whether the blocks' second moments still wait to be summed."""
    return (path / _BLOCKS).is_dir()


def finish_campaign(path: Path) -> None:
    """Once every case has been run, sum the blocks' second moments and clear up.

    Before that, and a second time, it changes nothing. Stopped on its way it begins anew; two
    that finish the same campaign at once write the same bytes.
    """
    _, result, _ = campaign_results(path)
    if np.any(result == NOT_RUN):
        return
    if campaign_unsummed(path):
        _sum_up(path, answers=int(np.sum(has_answer(result))))
    for kind in ("unborn", "spent"):  # what a kill left behind
        for left in path.parent.glob(f".{escape(path.name)}.{'?' * 8}.{kind}"):
            shutil.rmtree(left, ignore_errors=True)


def not_a_campaign(path: Path) -> RecordError:
    """The refusal of whatever else is there."""
    return RecordError(
        f"{path}: there is no campaign here. Give the folder that `seacage campaign run` "
        "wrote, or a NetCDF file exported from it."
    )


def _array(path: Path, name: str) -> Any:
    import zarr

    return zarr.open_array(path / name, mode="r+")


def _variables(*, in_time: bool, quantiles: bool, moment: bool, lines: bool) -> dict[str, Variable]:
    """Of a campaign of equilibria, or of one in time."""
    variables = {**SEA, **MEAN, "result": _RESULT, "core_seconds": _CORE_SECONDS}
    in_waves = {"wave_seed": _WAVE_SEED, "quantile": _QUANTILE, **SPREAD}
    variables |= in_waves if in_time else {"residual": _RESIDUAL}
    if lines:
        variables |= _LOADS | {f"line_{name}": line_variable(name) for name in CONSTANT}
    if moment:
        variables["second_moment"] = _SECOND_MOMENT
    return {n: one for n, one in variables.items() if quantiles or "quantile" not in one.dims}


def _create_array(
    group: Any, name: str, variable: Variable, size: Mapping[str, int], chunk: Mapping[str, int]
) -> None:
    empty: Mapping[str, float] = {"int8": NOT_RUN, "int64": 0}
    group.create_array(
        name,
        shape=tuple(size[dim] for dim in variable.dims),
        chunks=tuple(chunk[dim] for dim in variable.dims),
        dtype=variable.dtype,
        fill_value=empty.get(variable.dtype, np.nan),
        dimension_names=variable.dims,
        attributes=_attributes(name, variable),
    )


def _create_block_moments(group: Any, blocks: int, coordinates: int) -> None:
    """Room for one matrix a block, NaN until written.

    In single precision, whose rounding is far below the sampling error of half an hour.
    """
    group.create_group(_BLOCKS).create_array(
        "moment",
        shape=(blocks, coordinates, coordinates),
        chunks=(1, coordinates, coordinates),
        dtype="float32",
        fill_value=np.nan,
    )


def _sum_up(path: Path, *, answers: int) -> None:
    """Write the second moment of all blocks, in their order, and put them away."""
    try:
        moments = _array(path, f"{_BLOCKS}/moment")
        total = np.zeros(moments.shape[1:])
        for number in range(moments.shape[0]):
            total += moments[number]
    except FileNotFoundError:  # another process did it meanwhile
        return
    if np.isnan(total).any():  # the same, a little later: missing blocks read as NaN
        return
    mean = total / answers if answers else np.full_like(total, np.nan)
    _array(path, "second_moment")[:] = mean
    with suppress(FileNotFoundError):
        (path / _BLOCKS).rename(_beside(path, "spent"))  # at once: a half would be in the way


def _beside(path: Path, kind: str) -> Path:
    """A hidden neighbour of a store, with a name that no other process has."""
    return path.with_name(f".{path.name}.{uuid.uuid4().hex[:8]}.{kind}")


def _attributes(name: str, variable: Variable) -> dict[str, Any]:
    attributes = variable.attributes
    if "axis" in variable.dims:
        attributes["comment"] = "axis: x east, y north, z up; z = 0 at still water"
    if "case" in variable.dims and name not in {**SEA, **SHEAR}:
        attributes["coordinates"] = " ".join(SEA)
    if name == "result":
        attributes["flag_values"] = [NOT_RUN, *(int(code) for code in Result)]
        attributes["flag_meanings"] = " ".join(["not_run", *(code.name.lower() for code in Result)])
    return attributes
