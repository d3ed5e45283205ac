"""The page on other systems: its names are there, its commands and queries work."""

import json
import os
import re
import sqlite3
import subprocess
import sys
from contextlib import closing
from dataclasses import replace
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
from seacage.twin import Action, Alarm, AlarmBook, AlarmEvent
from stores import NOON, opened, put, sample, schema

PAGE = (Path(__file__).parents[2] / "docs/integrate.md").read_text()
PANEL, MEANS, WAITING, JOURNAL = re.findall(r"```sql\n(.+?)```", PAGE, re.DOTALL)


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
    """Ten minutes of a sensor and a buoy, and one reading that is no number."""
    samples = [sample(minute, 14.0 + minute / 10.0) for minute in range(11)]
    currents = [
        replace(sample(minute, stream="buoy-1"), values={"current_speed_m_s": 0.4 + minute / 90.0})
        for minute in range(10)
    ]
    put(store, *samples, *currents, sample(3, float("nan"), stream="depth-2"), limits=Limits())


@pytest.fixture(autouse=True)
def _summed_up_at_once(monkeypatch):
    """Spans of time need not rest for half a minute before they are summed up."""
    monkeypatch.setattr(_aggregates, "RESTED", timedelta(0))


def answers(execute, store):
    """What the page's queries find; that of the means once the service has summed up what came."""
    fill(store)
    alarm = Alarm(name="load.bridle-1", active=True, acknowledged=False, since=NOON, value=0.7)
    line = AlarmEvent(alarm=alarm.name, action=Action.RAISED, t=NOON, value=0.7)
    book = AlarmBook().with_alarm(alarm).with_alarm(Alarm(name="load.bridle-2"))
    store.keep_alarms("ace", book=book.to_json(), journal=[line]).result(20)
    milliseconds = {"$__from": "1580558580000", "$__to": "1580559120000"}  # 12:03 to 12:12
    panel = re.sub(r"\$__\w+", lambda one: milliseconds[one[0]], PANEL)
    means = eventually(lambda: execute(MEANS).fetchall(), bool, seconds=20)
    asked = (execute(query).fetchall() for query in (panel, WAITING, JOURNAL))
    return means, *asked


def check_answers(means, depths, waiting, journal, time):
    assert [one[1] for one in means] == ["buoy-1"]
    assert means[0][2] == pytest.approx(0.45)
    assert [one[0] for one in depths] == [time(minute) for minute in range(3, 11)]
    assert depths[-1] == (time(10), "depth-1", 15.0)
    assert [(*one[:2], one[3]) for one in waiting] == [("ace", "load.bridle-1", 0.7)]
    assert journal == [("ace", time(0), "load.bridle-1", "raised", "", "")]


def test_the_queries_of_the_page_answer_beside_the_service_in_sqlite(tmp_path):
    with opened(tmp_path / "samples.sqlite") as store:
        place = f"file:{tmp_path}/samples.sqlite?mode=ro"
        with closing(sqlite3.connect(place, uri=True)) as reader:
            found = answers(reader.execute, store)
    assert found[2][0][2] == "2020-02-01 12:00:00"
    check_answers(*found, lambda minute: f"2020-02-01 12:{minute:02}:00.000")


def test_the_queries_of_the_page_answer_beside_the_service_in_postgresql(postgres):
    with (
        schema(postgres) as url,
        opened(url) as store,
        psycopg.connect(url, autocommit=True) as reader,
    ):
        found = answers(reader.execute, store)
    assert found[2][0][2] == datetime(2020, 2, 1, 12)  # noqa: DTZ001 (a timestamp without zone)
    check_answers(*found, lambda minute: datetime(2020, 2, 1, 12, minute))  # noqa: DTZ001


def test_the_page_names_the_columns_of_the_views(tmp_path):
    rows = re.findall(r"^\| `(\w+)` \| [^|]+ \| (.+) \|$", PAGE, re.MULTILINE)
    with (
        opened(tmp_path / "samples.sqlite"),
        closing(sqlite3.connect(tmp_path / "samples.sqlite")) as reader,
    ):
        for view, words in rows:
            cursor = reader.execute(f"SELECT * FROM {view}")
            columns = {name for name, *_ in cursor.description} - {"cage", "t_utc", "t_us"}
            if view == "readings_10min":  # "means of the same"
                columns -= {"hs_m", "tp_s", "depth_m", "tension_kn"}
            assert columns == set(re.findall(r"`(\w+)`", words)), view
    assert len(rows) == 5


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
