"""A virtual field in time, with the true simulator, survives whatever happens to it."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from seacage.conventions import InputError
from seacage.records import FieldRecord, TrueMeans

# Twelve minutes of a small cage, in stretches of 40 s; a bridle is cut on the way.
SCRIPT = """
import sys
from datetime import UTC, datetime, timedelta
from seacage.cage import Cage
from seacage.campaigns import (
    Event, TruthParameters, Timetable, generated_current, generated_waves, virtual_field
)
def tell(stage, done, total):
    print(stage, flush=True)
folder, workers, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
mesh = {"ring_depths_m": [0.0, 7.0, 15.0, 23.0], "spokes": 16}
start = datetime(2020, 1, 18, tzinfo=UTC)
buoy = generated_current(0, start=start, days=1.0).between(start, start + timedelta(minutes=13))
virtual_field(
    Cage.named("ace").altered(mesh=mesh), buoy, hidden=TruthParameters.read(), seed=seed,
    waves=generated_waves(0, start=start, days=1.0),
    events=[Event.parse("bridle-cut bridle-8 2020-01-18T00:06Z")],
    timetable=Timetable(stretch=40.0, spin_up=20.0, mean=20.0, time_step=0.002),
    kept=folder + "/stretches", workers=workers, progress=tell,
).write(folder)
"""


def command(folder: Path, *, workers: int, seed: int = 0) -> list[str]:
    return [sys.executable, "-c", SCRIPT, str(folder), str(workers), str(seed)]


def contents(folder: Path) -> dict[str, bytes]:
    """Every file with its bytes, but for what a kill left half written."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.suffix != ".unborn"
    }


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A field that nothing disturbed, on one process."""
    folder = tmp_path_factory.mktemp("whole")
    subprocess.run(command(folder, workers=1), check=True, capture_output=True)
    return folder


@pytest.mark.slow
def test_a_field_killed_in_the_middle_goes_on_and_ends_with_the_same_bytes(
    whole: Path, tmp_path: Path
) -> None:
    running = subprocess.Popen(command(tmp_path, workers=2), stdout=subprocess.PIPE, text=True)
    assert running.stdout is not None
    while not list(tmp_path.rglob("*.safetensors")):
        assert running.stdout.readline() == "virtual field, simulated hours\n"
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    running.stdout.close()
    done = set(tmp_path.rglob("*.safetensors"))
    assert 0 < len(done) < len(set(whole.rglob("*.safetensors")))
    written = {path: path.stat().st_mtime_ns for path in done}
    subprocess.run(command(tmp_path, workers=2), check=True, capture_output=True)
    assert {path: path.stat().st_mtime_ns for path in done} == written
    assert contents(tmp_path) == contents(whole)


@pytest.mark.slow
def test_a_cut_bridle_shows_on_the_others_and_in_the_truth(whole: Path) -> None:
    truth, means = FieldRecord.read(whole / "truth"), TrueMeans.read(whole / "truth")
    cut = np.datetime64("2020-01-18T00:06:00")
    after = means.time >= cut
    tension = means.bridle_tension_mean[:, means.bridle_names.index("bridle-8")]
    assert tension[~after].max() > 0.0
    np.testing.assert_array_equal(tension[after], 0.0)
    assert any("bridle-cut bridle-8" in note for note in truth.notes)
    assert not any("bridle" in note for note in FieldRecord.read(whole).notes)


@pytest.mark.slow
def test_another_field_does_not_go_on_in_the_same_folder(whole: Path) -> None:
    ended = subprocess.run(
        command(whole, workers=1, seed=7), capture_output=True, text=True, check=False
    )
    assert InputError.__name__ in ended.stderr
    assert "stretches of a field with another seed. Give another folder" in ended.stderr
