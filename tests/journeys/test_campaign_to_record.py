"""Sea states become a campaign that survives whatever happens to it."""

import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from seacage.cage import Cage
from seacage.campaigns import (
    Plan,
    Simulator,
    TruthParameters,
    campaign_status,
    generated_current,
    run_campaign,
    run_share,
    virtual_field,
)
from seacage.campaigns._virtual_field import _responses
from seacage.conventions import SeacageError
from seacage.dynamics import rest_shape, simulate
from seacage.ocean import SeaState
from seacage.records import CampaignRecord, export_campaign, read_campaign

MESH = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 8}
SMALL = Cage.named("ace").altered(mesh=MESH)
SIXTEEN = Cage.named("ace").altered(mesh={**MESH, "spokes": 16})
PLAN = Plan.named("default", 1, 90, duration=20.0)
SHORT = {"ramp": 5.0, "spin_up": 10.0}

SCRIPT = """
import sys
import time
from seacage.cage import Cage
from seacage.campaigns import Plan, run_campaign
def tell(stage, done, total):
    print(done, flush=True)
    time.sleep(600 if done else 0)
run_campaign(
    Cage.read(sys.argv[1]), Plan.read(sys.argv[2]), sys.argv[3],
    workers=2, ramp=5.0, spin_up=10.0, progress=tell,
)
"""

PLAIN = """
import sys
import xarray
with xarray.open_dataset(sys.argv[1]) as file, xarray.open_zarr(sys.argv[2]) as store:
    assert file.sizes == store.sizes
    assert set(file.variables) == set(store.variables)
    for name in store.variables:
        xarray.testing.assert_equal(file[name].load(), store[name].load())
        assert file[name].attrs["units"] == store[name].attrs["units"]
    assert set(store.coords) == {
        "current_speed", "current_to", "hs", "tp", "wave_from", "quantile"
    }
    median = store.bridle_tension_quantile.sel(quantile=0.5)
    assert float(abs(median - store.bridle_tension).max()) < 10e3
    assert store.attrs["origin"] == file.attrs["origin"] == "computed"
    assert store.second_moment.dims == ("coordinate", "other_coordinate")
assert not any(name.startswith("seacage") for name in sys.modules)
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign in time that nothing disturbed, on one process."""
    out = tmp_path_factory.mktemp("whole") / "campaign"
    run_campaign(SMALL, PLAN, out, workers=1, **SHORT)
    return out


@pytest.fixture(scope="module")
def settled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign of equilibria that nothing disturbed, on one process."""
    out = tmp_path_factory.mktemp("settled") / "campaign"
    run_campaign(SIXTEEN, Plan.sample(1, 64), out, workers=1, method="settle")
    return out


def contents(folder: Path) -> dict[str, bytes]:
    """Every file with its bytes, but for what the blocks cost and what a kill left half written."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and "core_seconds/c" not in str(path) and path.suffix != ".partial"
    }


def test_sea_states_become_a_record_of_what_waves_do(whole: Path) -> None:
    record = read_campaign(whole)
    assert record.converged.all()
    assert record.result.shape == (len(PLAN),)
    for name in ("node_position", "bridle_tension"):
        least, most = getattr(record, f"{name}_minimum"), getattr(record, f"{name}_maximum")
        mean, levels = getattr(record, name), getattr(record, f"{name}_quantile")
        # Statistics beside the means have four bytes, of some 5e4 N at most.
        assert np.all(least <= mean + 0.01)
        assert np.all(mean <= most + 0.01)
        assert np.all(np.diff(levels, axis=1) >= -0.01)
    hs = np.array([sea.hs for sea in record.seas])
    heave = record.node_position_std[:, 0, 2]
    assert heave[hs > 2.0].min() > 3.0 * heave[hs < 0.5].mean()
    assert Cage.from_toml(record.cage_toml) == SMALL
    away = (record.node_position - SMALL.design_position).reshape(len(PLAN), -1)
    # The mean square is the square of the mean and more.
    assert np.all(np.diag(record.second_moment) >= 0.999 * np.mean(away**2, axis=0))
    np.testing.assert_allclose(record.second_moment, record.second_moment.T, rtol=1e-4, atol=1e-4)


def test_a_single_case_is_repeated_by_its_seed(whole: Path) -> None:
    record, case = read_campaign(whole), 41
    again = simulate(
        SMALL,
        record.seas[case],
        seed=int(record.wave_seed[case]),
        duration=PLAN.duration,
        sample_every=None,
        **SHORT,
    )
    np.testing.assert_array_equal(again.node.mean, record.node_position[case])
    np.testing.assert_array_equal(again.bridle.maximum, record.bridle_tension_maximum[case])


def test_equilibria_become_a_record_that_can_be_learned_from(settled: Path) -> None:
    record = read_campaign(settled)
    assert record.converged.mean() > 0.95
    done = record.converged
    assert np.isfinite(record.node_position[done]).all()
    assert record.residual[done].max() < 1.0
    speed = np.array([sea.current_speed for sea in record.seas])
    slow, fast = done & (speed < 0.2), done & (speed > 0.8)
    assert record.volume[fast].mean() < record.volume[slow].mean()
    assert record.bridle_tension[fast].max() > 2.0 * record.bridle_tension[slow].max()


@pytest.mark.slow
def test_the_answers_do_not_depend_on_the_number_of_processes(whole: Path, tmp_path: Path) -> None:
    run_campaign(SMALL, PLAN, tmp_path / "campaign", workers=2, **SHORT)
    assert contents(tmp_path / "campaign") == contents(whole)


@pytest.mark.slow
def test_a_killed_campaign_goes_on_and_ends_with_the_same_bytes(
    whole: Path, tmp_path: Path
) -> None:
    out = tmp_path / "campaign"
    SMALL.write(tmp_path / "cage.toml")
    PLAN.write(tmp_path / "plan.json")
    command = [sys.executable, "-c", SCRIPT, tmp_path / "cage.toml", tmp_path / "plan.json", out]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "0\n"
        assert process.stdout.readline() == "16\n"
        os.kill(process.pid, signal.SIGKILL)
    assert 16 <= campaign_status(out).done < len(PLAN)
    run_campaign(SMALL, PLAN, out, workers=1, **SHORT)
    assert contents(out) == contents(whole)


@pytest.mark.slow
def test_a_campaign_whose_worker_was_killed_goes_on_and_ends_with_the_same_bytes(
    whole: Path, tmp_path: Path
) -> None:
    def kill_soon(_stage: str, done: int, _total: int) -> None:
        threading.Thread(target=kill_one, daemon=True).start()

    def kill_one() -> None:
        while len(workers := multiprocessing.active_children()) < 2:
            time.sleep(0.01)
        time.sleep(0.2)  # a pool that breaks while it starts its second process says so in a thread
        os.kill(workers[0].pid, signal.SIGKILL)

    out = tmp_path / "campaign"
    by = Simulator(**SHORT)
    run_share(SMALL, PLAN, out, by=by, share=(1, 2), workers=1)
    with pytest.raises(SeacageError, match="ended from outside"):
        run_campaign(SMALL, PLAN, out, workers=2, progress=kill_soon, **SHORT)
    assert 16 <= campaign_status(out).done < len(PLAN)
    run_campaign(SMALL, PLAN, out, workers=1, **SHORT)
    assert contents(out) == contents(whole)


@pytest.fixture
def cluster() -> "Iterator[object]":
    """Dask with two workers, each a process that its nanny starts again."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50
    ) as cluster:
        yield cluster


@pytest.mark.slow
def test_a_dask_cluster_gives_the_same_bytes_also_when_a_worker_is_killed(
    whole: Path, tmp_path: Path, cluster
) -> None:
    killed: list[int] = []

    def kill_one(_stage: str, done: int, _total: int) -> None:
        if done == 16:
            killed.append(next(iter(cluster.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    out = tmp_path / "campaign"
    address = cluster.scheduler_address
    run_campaign(SMALL, PLAN, out, cluster=address, progress=kill_one, **SHORT)
    assert killed
    assert contents(out) == contents(whole)


@pytest.mark.slow
def test_a_job_array_gives_the_same_bytes_as_one_run(whole: Path, tmp_path: Path) -> None:
    SMALL.write(tmp_path / "cage.toml")
    PLAN.write(tmp_path / "plan.json")
    seacage = Path(sys.executable).with_name("seacage")
    words = ["campaign", "--plan", "plan.json", "--cage", "cage.toml"]
    words += ["--ramp", "5", "--spin-up", "10"]
    result = subprocess.run(
        [seacage, "campaign", "slurm", "--tasks", "2", *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    (tmp_path / "job.sh").write_text(result.stdout)
    path = f"{seacage.parent}{os.pathsep}{os.environ['PATH']}"
    for task in ("1", "0"):
        environment = {**os.environ, "PATH": path, "SLURM_ARRAY_TASK_ID": task}
        subprocess.run(
            [shutil.which("bash") or "bash", "job.sh"], cwd=tmp_path, env=environment, check=True
        )
    assert contents(tmp_path / "campaign") == contents(whole)


@pytest.mark.slow
def test_an_exported_campaign_reads_the_same(whole: Path, settled: Path, tmp_path: Path) -> None:
    for store in (whole, settled):
        out = tmp_path / f"{store.parent.name}.nc"
        export_campaign(store, out)
        exported: CampaignRecord = read_campaign(out)
        assert exported.sha256 == read_campaign(store).sha256


@pytest.mark.slow
def test_plain_xarray_reads_a_campaign_and_its_export(whole: Path, tmp_path: Path) -> None:
    export_campaign(whole, tmp_path / "campaign.nc")
    command = [sys.executable, "-W", "error", "-c", PLAIN, tmp_path / "campaign.nc", whole]
    subprocess.run(command, check=True)


@pytest.mark.slow
def test_the_low_fidelity_underestimates_what_the_virtual_field_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A coarser grid of responses than the field's own: 128 equilibria instead of 512.
    monkeypatch.setattr(_responses, "_SPEEDS", (0.25, 0.5, 0.8, 1.2))
    monkeypatch.setattr(_responses, "_DIRECTIONS", tuple(range(0, 360, 45)))
    buoy = generated_current(3, start=datetime(2020, 1, 18, tzinfo=UTC), days=8.0)
    field = virtual_field(
        SIXTEEN, buoy, hidden=TruthParameters.read(), seed=1, method="settle", every_s=720.0
    )
    rows = slice(40, None, 30)
    seas = [
        SeaState(current_speed=speed, current_to=to)
        for speed, to in zip(
            buoy.values["current_speed_m_s"][rows], buoy.values["current_to_deg"][rows], strict=True
        )
    ]
    low = run_campaign(SIXTEEN, Plan.listed(seas), tmp_path / "low", workers=2, method="settle")
    rest = rest_shape(SIXTEEN)
    for sensor in SIXTEEN.depth_sensors:
        reading = field.record.sensors[sensor.name].values["depth_m"]
        lifted = low.node_position[:, sensor.node, 2] - rest[sensor.node, 2]
        assert 0.0 < lifted.mean() < np.mean(-reading - rest[sensor.node, 2])
