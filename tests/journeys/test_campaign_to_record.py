"""Sea states become a campaign that survives whatever happens to it."""

import os
import signal
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import (
    Hidden,
    Plan,
    campaign_status,
    generated_current,
    run_campaign,
    virtual_field,
)
from seacage.dynamics import rest_shape
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, export_campaign, read_campaign

MESH = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
SMALL = Cage.named("ace").altered(mesh=MESH)
PLAN = Plan.sample(1, 96)

SCRIPT = """
import sys
from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
def tell(stage, done, total):
    print(done, flush=True)
cage = Cage.named("ace").altered(
    mesh={"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
)
run_campaign(cage, Plan.sample(1, 96), sys.argv[1], workers=2, progress=tell)
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign that nothing disturbed, on one process."""
    out = tmp_path_factory.mktemp("whole") / "campaign"
    run_campaign(SMALL, PLAN, out, workers=1)
    return out


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_sea_states_become_a_record_that_can_be_learned_from(whole: Path) -> None:
    record = read_campaign(whole)
    assert record.converged.mean() > 0.95
    settled = record.converged
    assert np.isfinite(record.node_position[settled]).all()
    assert record.residual[settled].max() < 1.0
    speed = np.array([sea.current_speed for sea in record.seas])
    slow, fast = settled & (speed < 0.2), settled & (speed > 0.8)
    assert record.volume[fast].mean() < record.volume[slow].mean()
    assert record.bridle_tension[fast].max() > 2.0 * record.bridle_tension[slow].max()
    assert Cage.from_toml(record.cage_toml) == SMALL


def test_the_answers_do_not_depend_on_the_number_of_processes(whole: Path, tmp_path: Path) -> None:
    run_campaign(SMALL, PLAN, tmp_path / "campaign", workers=2)
    assert contents(tmp_path / "campaign") == contents(whole)


def test_a_killed_campaign_goes_on_and_ends_with_the_same_bytes(
    whole: Path, tmp_path: Path
) -> None:
    out = tmp_path / "campaign"
    command = [sys.executable, "-c", SCRIPT, str(out)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "0\n"
        assert process.stdout.readline() == "32\n"
        os.kill(process.pid, signal.SIGKILL)
    assert 32 <= campaign_status(out).done < 96
    run_campaign(SMALL, PLAN, out, workers=1)
    kept = {name: file for name, file in contents(out).items() if not name.endswith(".partial")}
    assert kept == contents(whole)


def test_an_exported_campaign_reads_the_same(whole: Path, tmp_path: Path) -> None:
    export_campaign(whole, tmp_path / "campaign.nc")
    exported: CampaignRecord = read_campaign(tmp_path / "campaign.nc")
    assert exported.sha256 == read_campaign(whole).sha256


def test_the_low_fidelity_underestimates_what_the_virtual_field_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A coarser grid of responses than the field's own: 128 equilibria instead of 512.
    monkeypatch.setattr("seacage.campaigns._responses._SPEEDS", (0.25, 0.5, 0.8, 1.2))
    monkeypatch.setattr("seacage.campaigns._responses._DIRECTIONS", tuple(range(0, 360, 45)))
    buoy = generated_current(3, start=datetime(2020, 1, 18, tzinfo=UTC), days=8.0)
    field = virtual_field(SMALL, buoy, hidden=Hidden.read(), seed=1, every_s=720.0)
    rows = slice(40, None, 30)
    seas = [
        SeaState(current_speed=speed, current_to=to)
        for speed, to in zip(
            buoy.values["current_speed_m_s"][rows], buoy.values["current_to_deg"][rows], strict=True
        )
    ]
    low = run_campaign(SMALL, Plan.listed(seas), tmp_path / "low", workers=2)
    rest = rest_shape(SMALL)
    for sensor in SMALL.depth_sensors:
        said = field.record.sensors[sensor.name].values["depth_m"]
        lifted = low.node_position[:, sensor.node, 2] - rest[sensor.node, 2]
        assert 0.0 < lifted.mean() < np.mean(-said - rest[sensor.node, 2])
