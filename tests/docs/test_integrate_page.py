"""The page on other systems: its names are there, its commands and queries work."""

import json
import os
import re
import sqlite3
import subprocess
import sys
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path

import httpx
import psycopg
import pytest
from jinja2.sandbox import ImmutableSandboxedEnvironment

from mqtt_broker import talking
from running_service import eventually, running
from seacage.records import Limits
from seacage.service._store import _aggregates
from seacage.testing import stand_in_twin
from stores import opened, put, sample, schema

PAGE = (Path(__file__).parents[2] / "docs/integrate.md").read_text()
LATEST, LATEST_PG, MEANS, JOURNAL = re.findall(r"```sql\n(.+?)```", PAGE, re.DOTALL)


def test_every_series_on_the_page_is_one_of_the_service(tmp_path):
    with running(tmp_path) as live:
        text = httpx.get(f"{live.address}/metrics").text
    known = set(re.findall(r"^# TYPE (\w+) ", text, re.MULTILINE))
    named = set(re.findall(r"`(seacage_\w+)`", PAGE))
    assert len(named) > 12
    assert named <= known
    for end in re.findall(r"`…(_\w+)`", PAGE):
        assert any(name.endswith(end) for name in known), end


def fill(store):
    """Ten minutes of a sensor and one reading that is no number."""
    samples = [sample(minute, 14.0 + minute / 10.0) for minute in range(11)]
    put(store, *samples, sample(3, float("nan"), stream="depth-2"), limits=Limits())


@pytest.fixture(autouse=True)
def _summed_up_at_once(monkeypatch):
    """Spans of time need not rest for half a minute before they are summed up."""
    monkeypatch.setattr(_aggregates, "RESTED", timedelta(0))


def means_by(execute):
    """What the page's query finds, once the service has summed up what came."""
    return eventually(lambda: execute(MEANS).fetchall(), bool, seconds=20)


def test_the_queries_of_sqlite_answer_beside_the_service(tmp_path):
    with opened(tmp_path / "samples.sqlite") as store:
        fill(store)
        place = f"file:{tmp_path}/samples.sqlite?mode=ro"
        with closing(sqlite3.connect(place, uri=True)) as reader:
            latest, means = reader.execute(LATEST).fetchall(), means_by(reader.execute)
            reader.execute(JOURNAL)
    assert latest == [("ace", "depth-1", "2020-02-01 12:10:00", "depth_m", 15.0, 1)]
    assert means[0][:3] == ("ace", "depth-1", "depth_m")
    assert means[0][4:] == pytest.approx((10, 14.45, 14.0, 14.9))


def test_the_queries_of_postgresql_answer_beside_the_service(postgres):
    with (
        schema(postgres) as url,
        opened(url) as store,
        psycopg.connect(url, autocommit=True) as reader,
    ):
        fill(store)
        latest, means = reader.execute(LATEST_PG).fetchall(), means_by(reader.execute)
    t = datetime(2020, 2, 1, 12, 10, tzinfo=UTC)
    assert latest == [("ace", "depth-1", t, "depth_m", 15.0, 1)]
    assert means[0][4:] == pytest.approx((10, 14.45, 14.0, 14.9))


@pytest.mark.slow
def test_a_sample_of_the_page_reaches_prometheus_and_home_assistant(mosquitto, tmp_path):
    (mqtt,) = re.findall(r"```toml\n(\[mqtt\].+?)```", PAGE, re.DOTALL)
    topic, buoy = re.search(r"-t (\S+/obs) .*?-m '(.+?)'", PAGE, re.DOTALL).groups()
    depth = re.search(r"-d '(\{\"samples\".+?)'", PAGE)[1]
    (device,) = re.findall(r"-r -n -t (\S+)", PAGE)
    (tmp_path / "seacage.toml").write_text(mqtt.replace(":1883", f":{mosquitto}"))
    stand_in_twin().write(tmp_path / "twin")
    serve = next(line for line in PAGE.splitlines() if "--mqtt" in line).split(" --mqtt")[0]
    words = serve.removeprefix("$ seacage ").split()
    command = [sys.executable, "-c", "from seacage.service import main; main()", *words]
    more = ["--config", "seacage.toml", "--port", "0", "--json"]
    now = datetime.now(UTC).isoformat()
    with (
        talking(mosquitto) as talker,
        subprocess.Popen(
            [*command, *more], cwd=tmp_path, stdout=subprocess.PIPE, env=os.environ | THREADS
        ) as service,
    ):
        try:
            about = json.loads(service.stdout.readline())
            address = about["address"]
            eventually(
                lambda: httpx.get(f"{address}metrics").text,
                lambda text: re.search(r"broker_connected\{.+\} 1\.0", text),
                seconds=20,
            )
            talker.say(topic, json.loads(buoy) | {"t": now})
            admin = {"Authorization": f"Bearer {about['admin_token']}"}
            body = {"samples": [json.loads(depth)["samples"][0] | {"t": now}]}
            call = f"{address}api/v1/cages/ace/samples"
            assert httpx.post(call, json=body, headers=admin).json()["accepted"] == 1
            (series,) = re.findall(r"\| grep (\w+)", PAGE)
            text = eventually(
                lambda: httpx.get(f"{address}metrics").text,
                lambda text: f"{series}{{" in text,
                seconds=20,
            )
            assert f'{series}{{bridle="bridle-1",cage="ace"}}' in text
            talker.listen(device)
            found = dict([talker.hears()])[device]
            talker.listen(found["state_topic"])
            state = next(
                said for _, said in iter(talker.hears, None) if said.get("valid")
            )  # those that were published before the sample are not
        finally:
            service.terminate()
            service.wait(60)
            service.stdout.close()
    template = found["components"]["bridle-bridle-1-tension_kn"]["value_template"]
    shown = ImmutableSandboxedEnvironment().from_string(template).render(value_json=state)
    assert float(shown) == state["bridles"][0]["tension_kn"]["mean"] > 0.0


THREADS = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
