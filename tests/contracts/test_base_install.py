"""On the base install a command that needs more says what to install."""

import re
import subprocess
import sys
from importlib.metadata import requires

import pytest

from seacage.cage import Cage
from seacage.testing import stand_in_twin

EXTRA = {
    "xarray", "pandas", "zarr", "h5netcdf", "h5py", "dask", "distributed", "threadpoolctl",
    "matplotlib", "jinja2", "jax", "optax", "psycopg", "pyarrow", "rosbags",
    "asyncua", "mhkit", "sklearn", "scikit-learn",
}  # fmt: skip
BARE = f"""
import sys

class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {EXTRA}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Absent())
from seacage.service import main
main()
"""


def bare(*words, folder):
    """A command where nothing of the extras can be imported."""
    words = [sys.executable, "-c", BARE, *map(str, words)]
    return subprocess.run(words, check=False, capture_output=True, text=True, cwd=folder)


def test_every_package_of_the_extras_is_absent_here():
    extras = [line for line in requires("seacage") or () if "extra ==" in line]
    optional = {line for line in extras if not re.search(r"extra == .(dev|docs)", line)}
    for line in optional:
        assert any(line.startswith(name) for name in EXTRA), line


SEA = ("--current-speed", 0.2, "--current-to", 90)
RECORD = "time,current_speed_m_s,current_to_deg\n2020-03-01T00:00:00Z,0.4,80\n"


@pytest.mark.parametrize(
    "words",
    [
        ("settle", *SEA, "--cage", "small.toml", "--out", "x.nc"),
        pytest.param(("serve", "--demo", "--data", "var", "--port", 0), marks=pytest.mark.slow),
        ("field", "import", "buoy.csv", "buoy.nc"),
        ("train", "--campaign", ".", "--out", "twin"),
        pytest.param(
            ("study", "paper", "--campaign", ".", "--out", "study"), marks=pytest.mark.slow
        ),
    ],
    ids=lambda words: words[0],
)
def test_a_command_names_the_extra_that_it_needs_in_one_sentence(tmp_path, words):
    Cage.named("ace").altered(mesh={"spokes": 16}).write(tmp_path / "small.toml")
    (tmp_path / "buoy.csv").write_text(RECORD)
    ran = bare(*words, folder=tmp_path)
    assert ran.returncode == 3, ran.stderr
    last = ran.stderr.splitlines()[-1]
    assert last.startswith("seacage: This needs ")
    assert last.endswith("Install it with: pip install 'seacage[sim]'.")
    assert "Traceback" not in ran.stderr
    assert "0 of" not in ran.stderr, "nothing is simulated before"


@pytest.mark.slow
def test_a_service_by_opc_ua_names_its_extra_before_it_begins(tmp_path):
    stand_in_twin().write(tmp_path / "twin")
    # below those that a system lends, so that no other test has it
    ran = bare("serve", "--twin", "twin", "--port", 0, "--opcua-port", 4841, folder=tmp_path)
    assert ran.returncode == 3, ran.stderr
    last = ran.stderr.splitlines()[-1]
    assert last.startswith("seacage: This needs asyncua")
    assert last.endswith("pip install 'seacage[opcua]'.")


def test_what_the_base_install_has_runs_there(tmp_path):
    Cage.named("ace").altered(mesh={"spokes": 16}).write(tmp_path / "small.toml")
    ran = bare("settle", *SEA, "--cage", "small.toml", "--json", folder=tmp_path)
    assert ran.returncode == 0, ran.stderr
