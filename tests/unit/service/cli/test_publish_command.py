import json
from datetime import timedelta

import pytest
from typer.testing import CliRunner

from running_service import Running, at
from seacage.service._cli._app import app

HEADER = "time,current_speed_m_s,current_to_deg\n"


def publish(*words):
    return CliRunner().invoke(app, ["publish", *map(str, words)], catch_exceptions=False)


@pytest.fixture(autouse=True)
def logs_as_they_were(monkeypatch):
    """The command's logs would go to a stream that ends with the test."""
    monkeypatch.setattr("seacage.service._logs.begin_logs", lambda _: None)


@pytest.fixture
def record(tmp_path):
    path = tmp_path / "buoy.csv"
    path.write_text(HEADER + "".join(f"{at(minute)},0.5,90\n" for minute in range(-20, 0)))
    return path


@pytest.fixture
def to(live: Running, tmp_path):
    token = live.service.tokens.mint(["ingest"], keep=False)
    return ("--to", live.address, "--token", token, "--spool", tmp_path / "spool", "--json")


def test_a_record_reaches_the_service_once(live: Running, record, to):
    answer = json.loads(publish(record, *to).stdout)
    assert (answer["read"], answer["acknowledged"], answer["spooled"]) == (20, 20, 0)
    assert len(live.cage.store.samples("ace", limit=100)) == 20
    again = json.loads(publish(record, *to).stdout)
    assert again["read"] == 1, "but for the last time, all was read before"


def test_a_sample_that_is_refused_is_reported_and_the_code_is_1(live: Running, record, to):
    result = publish(record, *to, "--stream", "buoy-9")
    assert result.exit_code == 1
    answer = json.loads(result.stdout)
    assert answer["rejected"] == 20
    assert "No stream is called 'buoy-9'" in answer["reasons"][0]
    assert "20 samples were refused" in result.stderr


def test_what_is_ahead_of_the_services_clock_waits_for_the_next_run(live: Running, tmp_path, to):
    record = tmp_path / "fast.csv"
    record.write_text(HEADER + "".join(f"{at(minute)},0.5,90\n" for minute in range(40, 60)))
    result = publish(record, *to)
    assert result.exit_code == 3
    answer = json.loads(result.stdout)
    assert (answer["acknowledged"], answer["rejected"], answer["ahead"]) == (0, 0, 20)
    assert "20 samples are ahead of the service's clock" in result.stderr
    live.clock.at += timedelta(hours=1)
    result = publish(record, *to)
    assert result.exit_code == 0
    assert json.loads(result.stdout)["acknowledged"] == 20
    assert len(live.cage.store.samples("ace", limit=100)) == 20


def test_where_nobody_answers_the_samples_wait_and_the_code_is_3(record, tmp_path):
    words = ("--to", "http://127.0.0.1:9", "--spool", tmp_path / "spool", "--patience-s", "1")
    result = publish(record, *words)
    assert result.exit_code == 3
    assert "20 samples wait in the spool" in result.stderr


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("missing.csv", "--to", "http://127.0.0.1:9"), "there is no such record"),
        (("-", "--follow", "--to", "http://127.0.0.1:9"), "--follow is for a growing file"),
        (("-", "--to", "127.0.0.1:9"), "no broker's address"),
        (("-", "--to", "mqtt://127.0.0.1", "--site", "a/b"), "no site's name"),
    ],
)
def test_a_command_line_that_cannot_work_is_refused(tmp_path, words, why):
    result = publish(*words, "--spool", tmp_path / "spool")
    assert result.exit_code == 1
    assert why in result.stderr
