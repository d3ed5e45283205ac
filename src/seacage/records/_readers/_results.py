"""Results of another simulator: its net, its lines and its cases, as a campaign."""

# xarray leaves parts of its signatures untyped.
# pyright: reportUnknownMemberType=false

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from seacage.cage import Cage, MooringLines, match_net, mooring_lines
from seacage.conventions import InputError, RecordError, Result
from seacage.records._campaign import CampaignRecord
from seacage.records._keys import NO_MEAN_PERIOD, is_mean_period
from seacage.records._readers._cf import open_foreign
from seacage.records._readers._sea_states import SEA_COLUMNS, numbers, sea_states
from seacage.records._readers._table import PLAIN, Table, read_table

if TYPE_CHECKING:
    import xarray

NODE_COLUMNS = ("name", "x_m", "y_m", "z_m")
EDGE_COLUMNS = ("node_1", "node_2")
WEAR = "damage_equivalent"  # which lines without a T-N curve lack
STATISTICS = ("mean", "std", "maximum", "mpm_3h", "expected_3h", WEAR)
# Empty where a line, slack nearly all the time, had too few peaks: the case's own maximum counts
OF_PEAKS = ("mpm_3h", "expected_3h")
UNITS = {"n": 1.0, "kn": 1e3}  # [N]
BRIDLE = "bridle"
STRETCHED = 0.1  # largest change of the collar's circumference: a pipe keeps its length [-]

_LINE_COLUMN = re.compile(rf"(?P<line>.+)_(?P<what>{'|'.join(STATISTICS)})_(?P<unit>[a-z]+)")


def read_results(
    folder: Path, cage: Cage, *, simulator: str, duration: float | None = None
) -> CampaignRecord:
    """A campaign from what another simulator computed of a cage.

    The campaign's cage has the mesh of that program's net. What is not in the files is not made up:
    the load on the netting is NaN, and statistics that no column has are left out.

    ``folder``: has ``nodes.csv``, ``edges.csv``, ``cases.csv`` and ``positions.nc``, as
    docs/simulators.md says. ``cage``: that was simulated; columns name its lines. ``simulator``:
    name and version, for what is trained from it. ``duration``: that each case's statistics are
    over; None where there are only means [s].

    Raises RecordError: a file, a column, a unit or a number is missing, or what it says cannot be.
    """
    simulated, names, rest = _read_net(folder, cage)
    table, known = read_table(folder / "cases.csv", PLAIN), mooring_lines(cage, anchored=True)
    labels = {"case": _labels(table, "case"), "node": names, "axis": ("x", "y", "z")}
    lines, loads = _read_lines(table, known)
    if len(loads) > 1 and not (duration and 0.0 < duration < math.inf):
        raise RecordError(
            f"{table.path}: its {', '.join(loads)} need the time that they are over. Give the "
            "duration of each case without its spin-up, in s (--duration)."
        )
    seas = sea_states(table, assumed=False)
    position = _read_positions(folder / "positions.nc", labels)
    mean, collar = position["node_position"], simulated.ring_nodes(0)
    _check_collar(folder / "positions.nc", rest[collar], mean[:, collar], labels["case"])
    return CampaignRecord(
        cage_toml=simulated.to_toml(),
        seas=seas,
        bridle_tension=loads["mean"][:, : cage.bridle_count],
        net_force=np.full((len(seas), 3), np.nan),
        volume=simulated.volume(mean),
        result=np.full(len(seas), Result.CONVERGED.value),
        law=simulator,
        seed=0,
        version=version("seacage"),
        duration=duration if duration and len(loads) > 1 else math.nan,
        line_names=lines,
        line_kinds=known.named(lines).kinds,
        lines=loads,
        simulator=simulator,
        **position,
    )


def _read_net(
    folder: Path, cage: Cage
) -> tuple[Cage, tuple[str, ...], Float[np.ndarray, "node 3"]]:
    """The cage with the net's mesh, and the names and places of its nodes at rest [m]."""
    nodes, edges = (read_table(folder / f"{one}.csv", PLAIN) for one in ("nodes", "edges"))
    for table, columns in ((nodes, NODE_COLUMNS), (edges, EDGE_COLUMNS)):
        if set(table.header) != set(columns):
            raise RecordError(
                f"{table.path}: its columns are {', '.join(table.header)}. Give "
                f"{', '.join(columns)}, with positions in m: x east, y north, z up."
            )
    names = _labels(nodes, "name")
    place = {name: row for row, name in enumerate(names)}
    ends = [[cell.strip() for cell in edges.column(one)] for one in EDGE_COLUMNS]
    for line, *pair in zip(edges.lines, *ends, strict=True):
        for name in pair:
            if name not in place:
                raise RecordError(
                    f"{edges.path}, line {line}: {nodes.path} has no node {name!r}. Give edges of "
                    "the net alone, by the names of its nodes."
                )
    rest = np.column_stack([numbers(nodes, column) for column in NODE_COLUMNS[1:]])
    joined = np.array([[place[name] for name in pair] for pair in zip(*ends, strict=True)])
    try:
        matched, order = match_net(cage, names, rest, joined)
    except InputError as error:
        raise RecordError(f"{nodes.path}, {edges.path.name}: {error}") from error
    return matched, tuple(str(one) for one in np.array(names)[order]), rest[order]


def _labels(table: Table, column: str) -> tuple[str, ...]:
    """Names in a column, each once."""
    if column not in table.header:
        raise RecordError(f"{table.path}: it has no column {column}, the name of each row. Add it.")
    names = tuple(cell.strip() for cell in table.column(column))
    name, times = Counter(names).most_common(1)[0]
    if times > 1 or "" in names:
        row = names.index("") if "" in names else len(names) - 1 - names[::-1].index(name)
        raise RecordError(
            f"{table.path}, line {table.lines[row]}: {column} = {names[row]!r} is empty or there "
            "before. Give every row a name of its own."
        )
    return names


def _read_lines(
    table: Table, known: MooringLines
) -> tuple[tuple[str, ...], dict[str, Float[np.ndarray, "case line"]]]:
    """Lines that have columns such as ``bridle-1_mean_n``, and their loads by statistic [N]."""
    columns = dict[tuple[str, str], Float[np.ndarray, " case"]]()
    for name in table.header:
        if name != "case" and name not in SEA_COLUMNS:
            line, statistic, factor = _line_column(table, name, known.names)
            blank = statistic in OF_PEAKS
            columns[line, statistic] = factor * numbers(table, name, blank=blank)
    bridles = [name for name, kind in zip(known.names, known.kinds, strict=True) if kind == BRIDLE]
    has = {line for line, _ in columns}
    names = tuple(name for name in known.names if name in has or name in bridles)
    there = [one for one in STATISTICS if one == "mean" or any(s == one for _, s in columns)]
    for line, statistic in product(names, there):
        if statistic != WEAR and (line, statistic) not in columns:
            raise RecordError(
                f"{table.path}: it has no column {line}_{statistic}_n or _kn. Give the mean of "
                f"every bridle of the cage's file ({', '.join(bridles)}), and what one line has of "
                "every line that has a column."
            )
    unknown = np.full(len(table.rows), np.nan)
    loads = {
        one: np.column_stack([columns.get((line, one), unknown) for line in names])
        for one in (*there, *(() if WEAR in there or len(there) == 1 else (WEAR,)))
    }
    if loads["mean"].mean() < 0.0:
        raise RecordError(
            f"{table.path}: tensions are negative in the mean. Let a pull be positive."
        )
    if empty := [one for one in OF_PEAKS if one in loads and np.isnan(loads[one]).all()]:
        raise RecordError(f"{table.path}: {empty[0]} is empty everywhere. Leave its columns out.")
    return names, loads


def _line_column(table: Table, name: str, lines: Sequence[str]) -> tuple[str, str, float]:
    """Line, statistic and factor of a column. Raises RecordError: it is none of a line."""
    found = _LINE_COLUMN.fullmatch(name)
    if found and found["line"] in lines and found["unit"] in UNITS:
        return found["line"], found["what"], UNITS[found["unit"]]
    why = "is neither case, a column of the sea state nor a tension"
    if found and found["line"] in lines:
        why = f"has the unit {found['unit']!r}"
    elif found:
        why = f"names a line that the cage's file has not ({', '.join(lines)})"
    elif name.endswith(STATISTICS):
        why = "has no unit"
    elif is_mean_period(name):
        why = f"is no sea state's. {NO_MEAN_PERIOD}"
    raise RecordError(
        f"{table.path}: the column {name!r} {why}. Sea states have {', '.join(SEA_COLUMNS)} "
        "(currents go to, waves come from a direction, clockwise from north), tensions such as "
        f"bridle-1_mean_kn a line, one of {', '.join(STATISTICS)}, and n or kn."
    )


def _read_positions(path: Path, labels: Mapping[str, Sequence[str]]) -> dict[str, Any]:
    """Node positions by the record's names, in the order of labels."""
    with open_foreign(path, whole=True) as dataset:
        if "node_position" not in dataset:
            raise RecordError(
                f"{path}: it has no variable node_position, the mean place of each node in each "
                "case. A twin's net, depths and clearances are trained on it: add it."
            )
        return {
            name: _in_order(path, dataset[name], labels)
            for name in ("node_position", "node_position_std")
            if name in dataset
        }


def _in_order(
    path: Path, variable: "xarray.DataArray", labels: Mapping[str, Sequence[str]]
) -> Float[np.ndarray, "case node 3"]:
    name = variable.name
    if set(variable.dims) != set(labels):
        raise RecordError(
            f"{path}: {name} has the dimensions {', '.join(map(str, variable.dims))}. Give it "
            f"{', '.join(labels)}, in any order."
        )
    if (unit := variable.attrs.get("units")) != "m":
        raise RecordError(
            f"{path}: {name} has {f'the units {unit!r}' if unit else 'no units'}. Convert it to "
            'metres, and give it the attribute units = "m".'
        )
    variable = variable.transpose(*labels)
    rows = list[list[int]]()
    for dim, expected in labels.items():
        given = list(expected)
        if dim in variable.coords:
            texts = np.asarray(variable[dim].values).tolist()
            given = [t.decode() if isinstance(t, bytes) else str(t) for t in texts]
        other = sorted({*given} ^ {*expected})
        if other or variable.sizes[dim] != len(expected):
            raise RecordError(
                f"{path}: {name} has {variable.sizes[dim]} along {dim}, not the {len(expected)} "
                f"that are known{f' (first that differs: {other[0]!r})' if other else ''}. Give "
                f"each {dim} once: cases and nodes by the names in cases.csv and nodes.csv, axes "
                "x, y and z."
            )
        rows.append([given.index(label) for label in expected])
    values = np.asarray(variable.values, dtype=np.float64)[np.ix_(*rows)]
    if not np.isfinite(values).all():
        case, node, _ = np.argwhere(~np.isfinite(values))[0].tolist()
        raise RecordError(
            f"{path}: {name} of node {labels['node'][node]} in case {labels['case'][case]} is no "
            "finite number. Leave a case that failed out of every file."
        )
    return values


def _check_collar(
    path: Path,
    rest: Float[np.ndarray, "spoke 3"],
    mean: Float[np.ndarray, "case spoke 3"],
    cases: Sequence[str],
) -> None:
    """Refuse positions of another unit, or in another order than is known."""
    around = [
        np.linalg.norm(one - np.roll(one, 1, axis=-2), axis=-1).sum(axis=-1) for one in (rest, mean)
    ]
    off = np.abs(around[1] / around[0] - 1.0)
    if (off > STRETCHED).any():
        case = int(np.argmax(off))
        raise RecordError(
            f"{path}: the collar's circumference is {around[1][case]:.4g} m in case {cases[case]} "
            f"and {around[0]:.4g} m at rest. Give metres, and nodes in the order of nodes.csv or "
            "with a coordinate node of their names."
        )
