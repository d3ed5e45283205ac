from dataclasses import replace

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.conventions import RecordError
from seacage.records import read_campaign, read_results, write_campaign
from seacage.testing import stand_in_campaign, stand_in_seas
from simulators import write_results
from wavy import CAGE, wavy_campaign


def test_renamed_and_shuffled_results_are_the_campaign(tmp_path):
    campaign = wavy_campaign()
    folder = write_results(tmp_path / "results", campaign)
    found = read_results(folder, CAGE, simulator="Other 1", duration=900.0)
    assert found.cage_toml == campaign.cage_toml
    assert found.seas == campaign.seas
    np.testing.assert_array_equal(found.node_position, campaign.node_position)
    np.testing.assert_array_equal(found.node_position_std, campaign.node_position_std)
    np.testing.assert_array_equal(found.bridle_tension, campaign.lines["mean"][:, :12])
    assert (found.line_names, found.line_kinds) == (campaign.line_names, campaign.line_kinds)
    for name, values in found.lines.items():
        np.testing.assert_array_equal(values, campaign.lines[name])
    assert np.isnan(found.net_force).all()
    write_campaign(found, tmp_path / "out.zarr", title="Results", plan="results", method="import")
    again = read_campaign(tmp_path / "out.zarr")
    assert again.simulator == "Other 1"
    assert again.duration == 900.0
    np.testing.assert_allclose(again.lines["mpm_3h"], found.lines["mpm_3h"], rtol=1e-6)  # float32
    with pytest.raises(RecordError, match="there is something already"):
        write_campaign(found, tmp_path / "out.zarr")


def test_kilonewtons_are_newtons_in_the_campaign(tmp_path):
    campaign = stand_in_campaign(CAGE, stand_in_seas(5))
    folder = write_results(tmp_path, campaign, unit="kn")
    found = read_results(folder, CAGE, simulator="Other 1")
    np.testing.assert_allclose(found.bridle_tension, campaign.bridle_tension, rtol=1e-14)


@pytest.mark.parametrize("heading", [0.0, 25.0])
@pytest.mark.parametrize("bearings", [None, [90.0 - 28.0 * spoke for spoke in range(12)]])
def test_a_net_of_other_rings_and_spokes_becomes_the_mesh_of_the_cage(tmp_path, heading, bearings):
    described = replace(Cage.named("ace"), heading=heading)
    other = {"spokes": 12, "ring_depths_m": [0.0, 4.0, 14.5, 20.0, 26.0]}
    other |= {"spoke_bearings_deg": bearings} if bearings else {}
    simulated = described.altered(mesh={**other, "cylinder_depth_m": 14.5, "tip_depth_m": 30.0})
    campaign = stand_in_campaign(simulated, stand_in_seas(5))
    found = read_results(write_results(tmp_path, campaign), described, simulator="Other 1")
    cage = Cage.from_toml(found.cage_toml)
    assert (cage.rings, cage.spokes, cage.tube_ring) == (5, 12, 2)
    assert (cage.mesh.spoke_bearings is None) == (bearings is None)
    # Bearings are kept to 1e-4 degrees, which are 0.04 mm here.
    np.testing.assert_allclose(cage.design_position, simulated.design_position, atol=1e-4)
    np.testing.assert_array_equal(found.node_position, campaign.node_position)
    np.testing.assert_allclose(found.volume, campaign.volume, rtol=1e-12)


def edit(name, old, new, count=-1):
    """Replace text in a file."""

    def change(folder):
        path = folder / name
        text = path.read_text()
        assert old in text, text[:300]
        path.write_text(text.replace(old, new, count))

    return change


def column(name, change, *, row=None):
    """Change a column of nodes.csv, in one row or all."""

    def rewrite(folder):
        header, *rows = (folder / "nodes.csv").read_text().splitlines()
        at = header.split(",").index(name)
        for number, cells in enumerate(rows):
            if row in {None, number}:
                parts = cells.split(",")
                parts[at] = change(parts[at])
                rows[number] = ",".join(parts)
        (folder / "nodes.csv").write_text("\n".join([header, *rows]) + "\n")

    return rewrite


def positions(change):
    """Write positions.nc again, changed."""

    def rewrite(folder):
        import xarray

        with xarray.open_dataset(folder / "positions.nc", engine="h5netcdf") as dataset:
            changed = change(dataset.load())
        (folder / "positions.nc").unlink()
        changed.to_netcdf(folder / "positions.nc", engine="h5netcdf")

    return rewrite


def in_kilometres(dataset):
    dataset["node_position"].values /= 1e3
    return dataset


def with_units(units):
    def change(dataset):
        dataset["node_position"].attrs["units"] = units
        return dataset

    return change


def tail_cut(folder):
    """Leave out the last column's value of the second case."""
    lines = (folder / "cases.csv").read_text().splitlines()
    lines[2] = lines[2].rpartition(",")[0] + ",nan"
    (folder / "cases.csv").write_text("\n".join(lines) + "\n")


def turn_half(name):
    return lambda text: str(float(text) + name)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda folder: (folder / "edges.csv").unlink(), r"edges\.csv: the file cannot be read"),
        (lambda folder: (folder / "positions.nc").unlink(), r"positions\.nc: there is no such"),
        (edit("nodes.csv", "x_m", "x_km"), r"nodes\.csv: its columns are name, x_km.* m: x east"),
        (column("name", lambda _: "A", row=None), r"nodes\.csv, line 82: name = 'A' is .*before"),
        (column("x_m", lambda _: "east", row=3), r"nodes\.csv, line 5: x_m = 'east' is no finite"),
        (column("z_m", lambda z: str(-float(z))), r"negative z_m: change its sign"),
        (column("x_m", turn_half(6e5)), r"x_m = 600000, .*subtract"),
        (
            edit("edges.csv", "N004,", "M9,", 1),
            r"edges\.csv, line \d+: .*nodes\.csv has no node 'M9'",
        ),
        (
            edit("cases.csv", "current_to_deg", "current_from_deg"),
            "currents go to, waves come from",
        ),
        (edit("cases.csv", "current_speed_m_s", "current_kn"), "column 'current_kn' is neither"),
        (edit("cases.csv", "hs_m,tp_s", "hs_m,tz_s"), "'tz_s' is no sea state's. This is a mean"),
        (edit("cases.csv", "bridle-1_mean_n", "bridle-1_mean"), "'bridle-1_mean' has no unit"),
        (edit("cases.csv", "bridle-1_mean_n", "bridle-1_mean_lbf"), "has the unit 'lbf'"),
        (edit("cases.csv", "bridle-1_mean_n", "rope 7_mean_n"), r"names a line that .*\(bridle-1"),
        (
            edit("cases.csv", "bridle-1_mean_n", "bridle-1_std_n"),
            "no column bridle-1_mean_n or _kn",
        ),
        (edit("cases.csv", "case,", "run,"), "it has no column case"),
        (edit("cases.csv", "run 3,", "run 2,"), r"line 5: case = 'run 2' is empty or there before"),
        (tail_cut, r"cases\.csv, line 3: bridle-\d+_mean_n = 'nan' is no finite number"),
        (positions(with_units("km")), "node_position has the units 'km'. Convert it to metres"),
        (positions(with_units("")), "node_position has no units"),
        (positions(in_kilometres), r"circumference is 0\.15\d* m in case run 0 and 15\d\.\d m"),
        (positions(lambda d: d.rename(node="point")), "dimensions axis, point, case. Give it case"),
        (positions(lambda d: d.isel(case=slice(3))), "has 3 along case, not the 5 that are known"),
        (positions(lambda d: d.isel(node=slice(1, None))), "has 80 along node, not the 81"),
        (positions(lambda d: d.drop_vars("node")), "nodes in the order of nodes.csv"),
        (positions(lambda d: d.where(d.case != "run 1")), "in case run 1 is no finite number"),
        (positions(lambda d: d.rename(node_position="xyz")), "no variable node_position"),
    ],
)
def test_what_cannot_be_meant_is_refused_in_a_sentence_that_says_where(tmp_path, spoil, says):
    folder = write_results(tmp_path, stand_in_campaign(CAGE, stand_in_seas(5)))
    spoil(folder)
    with pytest.raises(RecordError, match=says):
        read_results(folder, CAGE, simulator="Other 1")


def test_edges_may_be_listed_twice_and_with_diagonals(tmp_path):
    campaign = stand_in_campaign(CAGE, stand_in_seas(3))
    folder = write_results(tmp_path, campaign)
    _, *rows = (folder / "edges.csv").read_text().splitlines()
    names = written_names(folder, CAGE)
    again = [",".join(reversed(row.split(","))) for row in rows[:40]]
    diagonals = [f"{names[CAGE.node(2, s)]},{names[CAGE.node(3, s + 1)]}" for s in range(8)]
    with (folder / "edges.csv").open("a") as file:
        file.write("\n".join([*again, *diagonals]) + "\n")
    found = read_results(folder, CAGE, simulator="Other 1")
    np.testing.assert_array_equal(found.node_position, campaign.node_position)


def written_names(folder, cage):
    """Names of a cage's nodes in its own order, by their places."""
    with (folder / "nodes.csv").open() as file:
        rows = [line.split(",") for line in file.read().splitlines()[1:]]
    places = np.array([[float(cell) for cell in row[1:]] for row in rows])
    away = np.linalg.norm(cage.design_position[:, None] - places, axis=2)
    return [rows[at][0] for at in away.argmin(axis=1)]


def test_a_pull_is_positive(tmp_path):
    pushed = stand_in_campaign(CAGE, stand_in_seas(3))
    pushed = replace(pushed, bridle_tension=-pushed.bridle_tension)
    with pytest.raises(RecordError, match="tensions are negative in the mean"):
        read_results(write_results(tmp_path, pushed), CAGE, simulator="Other 1")


def test_waves_are_given_as_they_were_simulated(tmp_path):
    sea = replace(stand_in_seas(2)[1], hs=1.0, tp=7.25, wave_from=200.0)
    folder = write_results(tmp_path, stand_in_campaign(CAGE, [sea] * 3))
    edit("cases.csv", "7.25", "", 1)(folder)
    with pytest.raises(RecordError, match=r"cases\.csv, line 2: its waves lack hs_m, tp_s or"):
        read_results(folder, CAGE, simulator="Other 1")
    path = folder / "cases.csv"
    rows = [line.split(",") for line in path.read_text().splitlines()]
    at = rows[0].index("tp_s")
    path.write_text("\n".join(",".join(row[:at] + row[at + 1 :]) for row in rows))
    with pytest.raises(RecordError, match="line 2: its waves lack"):
        read_results(folder, CAGE, simulator="Other 1")


def test_statistics_need_their_duration_and_every_line(tmp_path):
    folder = write_results(tmp_path, wavy_campaign(4))
    with pytest.raises(RecordError, match=r"its mean, std, .* \(--duration\)"):
        read_results(folder, CAGE, simulator="Other 1")
    edit("cases.csv", "buoy-1_mpm_3h_n", "buoy-1_damage_equivalent_n")(folder)
    with pytest.raises(RecordError, match="no column buoy-1_mpm_3h_n or _kn"):
        read_results(folder, CAGE, simulator="Other 1", duration=900.0)


def test_a_net_that_is_not_rings_around_a_tip_is_refused(tmp_path):
    folder = write_results(tmp_path, stand_in_campaign(CAGE, stand_in_seas(3)))
    nodes, edges = (folder / "nodes.csv").read_text(), (folder / "edges.csv").read_text()
    (folder / "nodes.csv").write_text(nodes + "frame corner,50,50,-8\n")
    with pytest.raises(RecordError, match=r"frame corner is not joined to N.* the net alone"):
        read_results(folder, CAGE, simulator="Other 1")
    (folder / "edges.csv").write_text(edges + "frame corner,N000\n")
    with pytest.raises(RecordError, match=r"the net has rings of .* nodes around N"):
        read_results(folder, CAGE, simulator="Other 1")
    (folder / "nodes.csv").write_text(nodes)
    first = edges.splitlines()[1]
    (folder / "edges.csv").write_text(edges.replace(first + "\n", "").replace(first + "\r\n", ""))
    with pytest.raises(RecordError, match=r"no edge from N|rings of|is not joined"):
        read_results(folder, CAGE, simulator="Other 1")
    far = Cage.named("ace").altered(mesh={"spokes": 8}, collar={"radius_m": 15.0})
    (folder / "edges.csv").write_text(edges)
    with pytest.raises(RecordError, match=r"radius of 25 m, the collar of cage \w+ 15 m"):
        read_results(folder, far, simulator="Other 1")
