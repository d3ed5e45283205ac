"""In an environment of its own each command works, or names the extra that it needs."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from seacage.cage import Cage

ROOT = Path(__file__).parents[2]
FROZEN = ROOT / "tests/frozen/0.1.0"
EXTRAS = ["sim", "gcn", "postgres", "archive", "ros", "opcua", "adcp", "bench"]
BROUGHT = {"adcp": "archive"}  # MHKiT needs pyarrow too
SEA = "--current-speed 0.2 --current-to 90"
POINT = f"--point 18,0,-8 --twin twin {SEA}"
COMMANDS = {
    "cage new new.toml": "",
    "cage check small.toml": "",
    "cage draw small.toml --out small.png": "sim",
    f"settle {SEA} --cage small.toml": "",
    f"settle {SEA} --cage small.toml --out settled.nc": "sim",
    f"simulate {SEA} --cage small.toml --duration 2": "",
    f"simulate {SEA} --cage small.toml --duration 2 --out moved.nc": "sim",
    "campaign run new.zarr --list seas.csv --cage small.toml": "sim",
    "campaign status campaign.zarr": "sim",
    "campaign export campaign.zarr campaign.nc": "sim",
    "campaign slurm new.zarr --tasks 2": "",
    "field import buoy.csv buoy.nc": "sim",
    "field check buoy.csv": "",
    "replay buoy.csv --twin twin --out answers.jsonl": "",
    f"clearance {POINT}": "",
    f"inspect-path --out way.mcap --twin twin {SEA}": "ros",
    "token new --data var --scope read": "",
    "token list --data var": "",
    "archive check archive": "archive",
    "archive read archive --cage ace": "archive",
    "backup backup.tar --data var --twin twin": "",
    "restore backup.tar --data again": "",
    "config show": "",
    "doctor --data var": "",
}
"""What works, and the extra without which it names that extra."""

BUOY = "time,current_speed_m_s,current_to_deg\n2020-03-01T00:00:00Z,0.4,80\n"
SEAS = "current_speed_m_s,current_to_deg\n0.2,90\n"
WAY = "name,east_m,north_m,up_m\na,0,0,-5\nb,18,0,-8\n"

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]  # installs, and starts Python 30 times


def constraints(path: Path) -> Path:
    """The versions of the lock, without its hashes, which pip would ask of the wheel too."""
    lock = (ROOT / "requirements-dev.lock").read_text()
    path.write_text("\n".join(re.findall(r"^[^\s#]+==[^\s\\]+(?: ;[^\\\n]+)?", lock, re.MULTILINE)))
    return path


@pytest.fixture(scope="module")
def install(tmp_path_factory, wheel):
    """Makes an environment of the wheel and some extras alone; returns its command line."""
    folder = tmp_path_factory.mktemp("environments")
    locked = constraints(folder / "locked.txt")

    def make(*extras: str) -> Path:
        there = folder / ("-".join(extras) or "base")
        uv = Path(sys.executable).with_name("uv")
        subprocess.run([uv, "venv", "--quiet", "--python", sys.executable, there], check=True)
        words = ["pip", "install", "--quiet", "--system-certs", "--constraint", locked]
        words += ["--python", there]
        named = f"seacage[{','.join(extras)}] @ {wheel.as_uri()}"
        subprocess.run([uv, *words, named], check=True)
        return there / "bin/seacage"

    return make


def files(folder: Path) -> None:
    """What the commands read."""
    shutil.copytree(FROZEN, folder, dirs_exist_ok=True)
    Cage.named("ace").altered(mesh={"spokes": 8}).write(folder / "small.toml")
    for name, text in (("buoy", BUOY), ("seas", SEAS), ("way", WAY)):
        (folder / f"{name}.csv").write_text(text)


def test_every_extra_is_tried() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    developers = {"dev", "docs"}
    assert {*project["optional-dependencies"]} - developers == {*EXTRAS}


@pytest.mark.parametrize("extra", ["", *EXTRAS])
def test_each_command_works_or_names_its_extra_in_one_sentence(install, tmp_path, extra):
    seacage = install(*filter(None, [extra]))
    files(tmp_path)
    environment = {k: v for k, v in os.environ.items() if k not in {"PYTHONPATH", "VIRTUAL_ENV"}}
    wrong = []
    for command, needed in COMMANDS.items():
        if extra and needed != extra:
            continue
        ran = subprocess.run(
            [seacage, *command.split()],
            check=False, capture_output=True, text=True, cwd=tmp_path, env=environment,
        )  # fmt: skip
        last = (ran.stderr.splitlines() or [""])[-1]
        refused = ran.returncode == 3 and last.startswith("seacage: ")
        named = refused and f"seacage[{needed}]" in last and "Traceback" not in ran.stderr
        if not (named if needed and needed != extra else ran.returncode == 0):
            wrong.append(f"{command}: {ran.returncode}\n{ran.stderr[-600:]}")
    assert not wrong, "\n\n".join(wrong)
    words = [seacage, "doctor", "--json"]
    ran = subprocess.run(words, check=True, capture_output=True, cwd=tmp_path, env=environment)
    states = {one["what"]: one["state"] for one in json.loads(ran.stdout)["findings"]}
    there = [one for one in EXTRAS if states[f"Extra {one}"] == "ok"]
    assert set(there) == {extra, BROUGHT.get(extra, "")} - {""}
