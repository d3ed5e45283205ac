"""What another simulator would write of a campaign: its own names of nodes, in its own order."""

import csv
from pathlib import Path

import numpy as np
import xarray

from seacage.cage import Cage
from seacage.records import CampaignRecord

UNITS = {"n": 1.0, "kn": 1e-3}


def write_results(
    folder: Path,
    campaign: CampaignRecord,
    *,
    rest: np.ndarray | None = None,
    seed: int = 1,
    unit: str = "n",
) -> Path:
    """Write a campaign as nodes.csv, edges.csv, cases.csv and positions.nc, shuffled by a seed."""
    random, cage = np.random.default_rng(seed), Cage.from_toml(campaign.cage_toml)
    rest = cage.design_position if rest is None else rest
    names = [f"N{number:03d}" for number in random.permutation(cage.node_count)]
    folder.mkdir(parents=True, exist_ok=True)
    nodes = [(name, *map(float, place)) for name, place in zip(names, rest, strict=True)]
    write(folder / "nodes.csv", ("name", "x_m", "y_m", "z_m"), shuffled(random, nodes))
    edges = [(names[a], names[b]) for a, b in shuffled(random, cage.edges.tolist())]
    write(folder / "edges.csv", ("node_1", "node_2"), edges)
    write_cases(folder / "cases.csv", campaign, random=random, unit=unit)
    node = random.permutation(cage.node_count)
    spread = campaign.node_position_std
    fields = {"node_position": campaign.node_position}
    fields |= {} if spread is None else {"node_position_std": spread}
    dataset = xarray.Dataset(
        {
            name: (
                ("axis", "node", "case"),
                np.moveaxis(values[:, node][..., [2, 0, 1]], 0, -1).swapaxes(0, 1),
                {"units": "m"},
            )
            for name, values in fields.items()
        },
        coords={
            "axis": ["z", "x", "y"],
            "node": [names[one] for one in node],
            "case": case_names(len(campaign)),
        },
    )
    dataset.to_netcdf(folder / "positions.nc", engine="h5netcdf")
    return folder


def write_cases(
    path: Path, campaign: CampaignRecord, *, random: np.random.Generator, unit: str
) -> None:
    """Write the sea state of each case, and its tensions in columns of any order."""
    columns: dict[str, list[object]] = {"case": list(case_names(len(campaign)))}
    for key, name in (
        ("current_to_deg", "current_to"),
        ("current_speed_m_s", "current_speed"),
        ("hs_m", "hs"),
        ("tp_s", "tp"),
        ("wave_from_deg", "wave_from"),
    ):
        columns[key] = [getattr(sea, name) for sea in campaign.seas]
    loads = dict(campaign.lines) or {"mean": campaign.bridle_tension}
    lines = campaign.line_names or Cage.from_toml(campaign.cage_toml).bridle_names
    for line in random.permutation(len(lines)).tolist():
        for statistic in ("mean", "std", "maximum", "mpm_3h", "expected_3h", "damage_equivalent"):
            if statistic in loads and not np.isnan(values := loads[statistic][:, line]).all():
                cells = ["" if np.isnan(one) else one * UNITS[unit] for one in values.tolist()]
                columns[f"{lines[line]}_{statistic}_{unit}"] = cells
    write(path, tuple(columns), list(zip(*columns.values(), strict=True)))


def case_names(count: int) -> list[str]:
    """Names of cases."""
    return [f"run {number}" for number in range(count)]


def shuffled(random: np.random.Generator, rows: list) -> list:
    """Rows in another order."""
    return [rows[at] for at in random.permutation(len(rows))]


def write(path: Path, header: tuple[str, ...], rows: list) -> None:
    """Write a table."""
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([header, *rows])
