"""The page on extensions: its package is laid beside seacage, and its commands use it."""

import json
import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

from extensions import install
from seacage.records import read_campaign, read_history, read_record
from seacage.testing import stand_in_field, stand_in_twin
from seacage.twin import Twin

pytestmark = pytest.mark.slow  # commands in processes of their own
PAGE = (Path(__file__).parents[2] / "docs/extend.md").read_text()
*PARTS, SUITE = re.findall(r"```python\n(.+?)```", PAGE, re.DOTALL)
(PYPROJECT,) = re.findall(r"```toml\n(.+?)```", PAGE, re.DOTALL)
(LOG,) = re.findall(r"```text\n(.+?)```", PAGE, re.DOTALL)
COMMANDS = {
    " ".join(words[: 2 if words[0] in {"campaign", "field"} else 1]): words
    for block in re.findall(r"```console\n(.+?)```", PAGE, re.DOTALL)
    for words in map(shlex.split, block.replace("$ seacage ", "").splitlines())
    if "--inspect" not in words
}
(INSPECT,) = re.findall(r"^\$ seacage (field import .+ --inspect)$", PAGE, re.MULTILINE)
LAW = "one-coefficient (farmlab 1.0)"
MAIN = "from seacage.service import main; main()"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    place, table = tmp_path_factory.mktemp("site"), tomllib.loads(PYPROJECT)["project"]
    points = table["entry-points"]
    install(place, table["name"], table["version"], points, "\n\n".join(PARTS))
    return place


@pytest.fixture
def run(tmp_path, site):
    """Run Python in an empty folder, beside the package or without it."""
    (tmp_path / "logger.fml").write_text(LOG)

    def run_in(*words, beside=True):
        path = os.pathsep.join([*([str(site)] if beside else []), *filter(None, sys.path)])
        return subprocess.run(
            [sys.executable, "-P", *words],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=False,
        )

    return run_in


@pytest.fixture
def seacage(run):
    def answer(*words, beside=True):
        result = run("-c", MAIN, *words, beside=beside)
        assert result.returncode == 0, f"{words}: {result.stderr}"
        return result.stdout

    return answer


def test_the_law_is_taken_wherever_one_of_ours_is(tmp_path, run, seacage):
    found = json.loads(seacage(*COMMANDS["settle"], "--json"))
    assert found["net_force_kn"][0] > 10.0
    seacage(*COMMANDS["simulate"])
    assert read_history(tmp_path / "sea.nc").settings["law"] == LAW
    seacage(*COMMANDS["campaign run"])
    campaign = read_campaign(tmp_path / "mine.zarr")  # without the package
    assert campaign.law == LAW
    assert campaign.converged.all()
    refused = run("-c", MAIN, *COMMANDS["campaign run"], beside=False)
    assert refused.returncode == 1
    assert refused.stderr.count("\n") == 1
    assert "No screen law 'one-coefficient'; there are: aarsnes, loland" in refused.stderr


def test_every_law_answers_beside_ours(seacage):
    by_law = json.loads(
        seacage("settle", "--current-speed", "0.5", "--current-to", "90", "--laws", "all", "--json")
    )
    assert "one-coefficient" in json.dumps(by_law)
    assert "loland" in json.dumps(by_law)


def test_the_doctor_lists_what_is_installed(run):
    (found,) = [run("-c", MAIN, *COMMANDS["doctor"])]
    assert '"Screen law one-coefficient"' in found.stdout
    assert '"Surrogate splines"' in found.stdout
    assert '"Reader farmlog"' in found.stdout


def test_the_reader_reads_its_files_and_no_others(tmp_path, run, seacage):
    assert "4 rows of tension_kn" in seacage(*shlex.split(INSPECT))
    seacage(*COMMANDS["field import"])
    seacage(*COMMANDS["field check"])
    record = read_record(tmp_path / "shackle-1.nc")
    assert record.stream == "shackle-1"
    assert record.notes[0] == "Read by the reader 'farmlog' of farmlab 1.0."
    np.testing.assert_allclose(record.values["tension_kn"][0], 412.5 * 9.80665e-3)
    assert str(record.time[0]) == "2026-01-05T09:00:00.000000"
    (tmp_path / "other.txt").write_text("FARMLOG 2\nstart yesterday\n")
    refused = run("-c", MAIN, "field", "import", "other.txt", "other.nc")
    assert refused.returncode == 1
    assert refused.stderr.startswith("seacage: other.txt: no FARMLOG file (")
    assert refused.stderr.count("\n") == 1
    plain = "time,hs_m\n2026-01-05T09:00:00Z,1.0\n2026-01-05T10:00:00Z,1.1\n"
    (tmp_path / "plain.csv").write_text(plain)
    assert "Read by" not in seacage("field", "import", "plain.csv", "plain.nc")


def test_the_surrogate_is_scored_beside_the_twin(tmp_path, run, seacage):
    twin = stand_in_twin()
    twin.write(tmp_path / "twin")
    stand_in_field(twin.cage).write(tmp_path / "field")
    found = json.loads(seacage(*COMMANDS["score"], "--json"))["baselines"]
    assert {one["sensor"] for one in found} == set(Twin.read(tmp_path / "twin").models.upper)
    name = "surrogate 'splines' of farmlab 1.0"
    for one in found:
        assert {"twin", "AR1", name} <= one["mae"].keys()
        assert np.isfinite(list(one["mae"].values())).all()
        assert one["gain"][name]["mean"] == pytest.approx(one["mae"][name] - one["mae"]["twin"])
    # splines of readings that are smooth in the current are no worse than a plain line by far
    depth = next(one for one in found if one["unit"] == "m")
    assert depth["mae"][name] < 2.0 * depth["mae"]["linear"]
    unknown = run("-c", MAIN, *COMMANDS["score"][:-1], "mine")
    assert unknown.returncode == 1
    assert "No surrogate 'mine'; there are: splines." in unknown.stderr


def test_its_tests_pass(tmp_path, run):
    (tmp_path / "test_farmlab.py").write_text(SUITE)
    done = run("-m", "pytest", "-q", "-p", "no:cacheprovider", "-c", os.devnull, "test_farmlab.py")
    assert done.returncode == 0, done.stdout
    assert "3 passed" in done.stdout
