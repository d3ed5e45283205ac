"""A farm served as its file of settings says: several cages, by HTTPS, with people who sign in."""

import json
import ssl
import subprocess
import sys
from contextlib import contextmanager

import httpx
import pytest

from outside import wait_for
from seacage.testing import stand_in_twin

SEACAGE = [sys.executable, "-c", "from seacage.service import main; main()"]


@pytest.fixture
def settings(tmp_path, certificate):
    """Two cages with one twin, by HTTPS."""
    stand_in_twin().write(tmp_path / "twin")
    file = tmp_path / "seacage.toml"
    file.write_text(
        f"""
        site = "bay"
        data = "{tmp_path / "data"}"
        port = 0
        certificate = "{certificate[0]}"
        key = "{certificate[1]}"
        [[cages]]
        name = "north"
        twin = "{tmp_path / "twin"}"
        [[cages]]
        name = "south"
        twin = "{tmp_path / "twin"}"
        """
    )
    return file


@contextmanager
def served(settings, certificate):
    command = [*SEACAGE, "serve", "--config", settings, "--json"]
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE) as process:
        try:
            answer = json.loads(process.stdout.readline())
            trust = ssl.create_default_context(cafile=certificate[0])
            with httpx.Client(base_url=answer["address"], verify=trust) as client:
                wait_for(lambda: client.get("/readyz").raise_for_status())
                yield answer, client
        finally:
            process.kill()


@pytest.mark.slow
def test_a_farm_is_served_as_its_file_says(settings, certificate, tmp_path):
    with served(settings, certificate) as (outcome, client):
        assert outcome["address"].startswith("https://")
        assert outcome["cages"] == ["north", "south"]
        admin = {"Authorization": f"Bearer {outcome['admin_token']}"}
        cages = client.get("/api/v1/cages", headers=admin).json()["cages"]
        assert [cage["name"] for cage in cages] == ["north", "south"]
        answer = client.post("/session", json={"token": outcome["admin_token"]})
        assert "Secure" in answer.headers["set-cookie"]
        assert client.get("/api/v1/cages/south/state").is_success
    kept = (tmp_path / "data" / "tokens.jsonl").read_text()
    assert outcome["admin_token"] not in kept
    assert '"who": "first start"' in (tmp_path / "data" / "audit.jsonl").read_text()
    with served(settings, certificate) as (again, client):
        assert "admin_token" not in again, "it is shown once"
        assert client.get("/api/v1/cages", headers=admin).is_success
