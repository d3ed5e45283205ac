"""From a logger's sample to the page's numbers, by the commands that people use."""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from typer.testing import CliRunner

from outside import wait_for
from seacage.service._cli._app import app
from seacage.testing import stand_in_field, stand_in_twin

SEACAGE = [sys.executable, "-c", "from seacage.service import main; main()"]


@pytest.fixture(scope="module")
def twin(tmp_path_factory):
    folder = tmp_path_factory.mktemp("twin") / "twin"
    stand_in_twin().write(folder)
    return folder


@pytest.fixture(scope="module")
def field(tmp_path_factory):
    folder = tmp_path_factory.mktemp("field") / "field"
    stand_in_field(stand_in_twin().cage, days=0.25).write(folder)
    return folder


@contextmanager
def serving(data: Path, *words: object) -> Iterator[tuple[str, httpx.Client]]:
    """A service of its own process; its address, and a client that may read."""
    command = [*SEACAGE, "serve", "--data", data, "--port", "0", "--json", *words]
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE) as process:
        try:
            answer = json.loads(process.stdout.readline())
            headers = {"Authorization": f"Bearer {answer['token']}"}
            with httpx.Client(base_url=answer["address"], headers=headers) as client:
                wait_for(lambda: client.get("/readyz").raise_for_status())
                yield answer["address"], client
        finally:
            process.kill()  # nothing that was acknowledged may need a goodbye


def run_command(*words: object) -> str:
    result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    return result.stdout


def until(ask, accept):
    """What is asked, once it is as it should be."""

    def attempt():
        if not accept(ask()):
            raise OSError("not yet")

    wait_for(attempt)
    return ask()


@pytest.mark.slow
def test_a_record_sent_by_http_outlives_a_kill_and_is_answered_in_its_past(twin, field, tmp_path):
    token = run_command("token", "new", "--data", tmp_path, "--scope", "ingest").splitlines()[-1]
    with serving(tmp_path, "--twin", twin) as (address, _):
        send = ("replay", field, "--to", address, "--token", token, "--json")
        receipt = json.loads(run_command(*send))
        assert receipt["accepted"] == receipt["sent"] > 500
        assert receipt["rejected_count"] == 0
    with serving(tmp_path, "--twin", twin) as (address, client):
        past = {"at": "2020-01-18T03:00:00Z"}
        state = client.get("/api/v1/cages/ace/state", params=past).json()
        assert state["valid"]
        assert all(sensor["measured"] is not None for sensor in state["sensors"])
        assert not client.get("/api/v1/cages/ace/state").json()["valid"], "the buoy is long stale"
        send = ("replay", field, "--to", address, "--token", token, "--json")
        assert json.loads(run_command(*send))["duplicates"] == receipt["sent"]


@pytest.mark.slow
def test_an_interrupt_stops_a_service_quietly(twin, tmp_path):
    command = [*SEACAGE, "serve", "--data", tmp_path, "--port", "0", "--twin", twin, "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        address = json.loads(process.stdout.readline())["address"]
        wait_for(lambda: httpx.get(f"{address}readyz").raise_for_status())
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=20) == 0
        assert process.stderr.read() == b""


@pytest.mark.slow
def test_a_buoys_record_is_replayed_on_its_own_clock(twin, field, tmp_path):
    words = ("--twin", twin, "--record", field / "buoy-1.nc", "--speed", "600")
    with serving(tmp_path, *words) as (_, client):
        ask = lambda: client.get("/api/v1/cages/ace/state").json()  # noqa: E731
        first = until(ask, lambda state: state["valid"])
        assert first["t"].startswith("2020-01-18")
        assert until(ask, lambda state: state["t"] > first["t"])["origin"] == "virtual field"
        topology = client.get("/api/v1/cages/ace/topology").json()
        assert topology["speed"] == 600.0
