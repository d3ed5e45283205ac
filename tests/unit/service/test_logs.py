import io
import json
import logging

import pytest
import structlog

from seacage.service._logs import begin_logs


@pytest.fixture(autouse=True)
def logging_as_it_was(monkeypatch):
    """Afterwards the process's logs are as they were."""
    monkeypatch.setattr(logging, "raiseExceptions", True)
    root = logging.getLogger()
    monkeypatch.setattr(root, "handlers", [])
    yield
    root.setLevel(logging.WARNING)
    structlog.reset_defaults()


def test_a_machine_gets_one_json_object_per_event(capsys):
    begin_logs("json")
    structlog.get_logger("seacage.test").info("stream back", cage="ace")
    output = json.loads(capsys.readouterr().err)
    assert (output["event"], output["cage"], output["level"]) == ("stream back", "ace", "info")
    assert output["timestamp"].endswith("Z")


def test_others_speak_the_same_way_and_only_where_something_is_wrong(capsys):
    begin_logs("json")
    logging.getLogger("uvicorn.error").info("started")
    logging.getLogger("uvicorn.error").error("no socket")
    assert json.loads(capsys.readouterr().err)["event"] == "no socket"


def test_a_log_that_cannot_be_written_stops_nobody(monkeypatch):
    closed = io.StringIO()
    monkeypatch.setattr("sys.stderr", closed)
    begin_logs("lines")
    closed.close()
    structlog.get_logger("seacage.test").warning("flagged")


def test_a_line_that_is_repeated_is_counted_and_not_written_again(capsys, monkeypatch):
    now = [0.0]
    monkeypatch.setattr("seacage.service._logs.time.monotonic", lambda: now[0])
    begin_logs("json")
    for _ in range(1000):
        logging.getLogger("asyncio").error("no %s", "socket")
        structlog.get_logger("seacage.test").warning("dropped", address="10.0.0.1")
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 200
    now[0] = 10.0
    logging.getLogger("asyncio").error("no %s", "socket")
    structlog.get_logger("seacage.test").warning("dropped", address="10.0.0.1")
    output = [json.loads(line)["event"] for line in capsys.readouterr().err.splitlines()]
    more = "(900 more like it were not written)"
    assert output == [f"no socket {more}", f"dropped {more}"]
    logging.getLogger("asyncio").error("another")
    assert json.loads(capsys.readouterr().err)["event"] == "another"
