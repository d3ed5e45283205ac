"""``seacage field`` on files that people bring."""

import json
import os

import pytest
from typer.testing import CliRunner

from seacage.service._cli import app

pytest.importorskip("xarray")


def run(*words):
    return CliRunner().invoke(app, [os.fspath(word) for word in words])


def test_a_new_file_is_inspected_and_only_imported_once_its_map_is_filled_in(tmp_path):
    table, columns, out = tmp_path / "t.csv", tmp_path / "map.toml", tmp_path / "buoy-1.nc"
    table.write_text("time,hs,temp\n2018-01-26T23:08:00Z,1.2,5\n")
    told = run("field", "import", table, columns, "--inspect", "--json")
    assert json.loads(told.stdout)["to_fill_in"] == 2
    refused = run("field", "import", table, out, "--columns", columns)
    assert refused.exit_code == 1
    assert 'origin is still "?"' in refused.stderr
    assert not out.exists()
    columns.write_text(
        columns.read_text().replace('origin = "?"', 'origin = "measured"').replace('"?"', '"m"')
    )
    assert run("field", "import", table, out, "--columns", columns).exit_code == 0
    assert run("field", "import", table, columns, "--inspect").exit_code == 1


def test_a_foreign_netcdf_is_imported_by_options_alone(tmp_path, shared):
    out = tmp_path / "adcp.nc"
    words = ("field", "import", shared / "data" / "adcp_awac_snippet.nc", out)
    assert "nothing says how its numbers were made" in run(*words, "--range-m", "5.4").stderr
    given = ("--origin", "measured", "--zone=-07:00", "--range-m", "5.4", "--json")
    streams = json.loads(run(*words, *given).stdout)["streams"]
    assert streams["buoy-1"]["rows"] == 100


def test_options_of_netcdf_beside_a_tables_map_are_refused(tmp_path):
    (tmp_path / "t.csv").write_text("a,b\n1,2\n")
    words = ("field", "import", tmp_path / "t.csv", tmp_path / "o.nc", "--columns", "nora10_waves")
    assert "are for NetCDF" in run(*words, "--range-m", "5.4").stderr
    assert "no column is at a depth of 5 m" in run(*words, "--depth-m", "5").stderr


def test_a_check_writes_its_page_and_obeys_the_sites_limits(tmp_path):
    pytest.importorskip("matplotlib")
    table, page, limits = tmp_path / "t.csv", tmp_path / "quality.html", tmp_path / "limits.toml"
    table.write_text("time,hs_m\n2018-01-26T23:08:00Z,3.2\n2018-01-26T23:28:00Z,3.1\n")
    limits.write_text("[ranges.hs_m]\nsuspect = [0, 3]\n")
    assert "2 good" in run("field", "check", table).stdout
    told = run("field", "check", table, "--report", page, "--limits", limits)
    assert "2 suspect" in told.stdout
    assert "hs_m = 3.2 is outside [0, 3]" in page.read_text()
